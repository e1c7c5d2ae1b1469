// The plate with physical lines: two named ones, one (of two curves) with a tag only.
Include "plate.geo";
Physical Curve("wall side", 11) = {5};
Physical Curve("pull", 12) = {2};
Physical Curve(7) = {3, 4};
Physical Surface("body", 20) = {1};
