// A small plate with one round corner, for the tests of the MSH reader. make.sh meshes it in every variant.
h = 0.02;
Point(1) = {0, 0, 0, h};
Point(2) = {0.06, 0, 0, h};
Point(3) = {0.06, 0.02, 0, h};
Point(4) = {0.04, 0.04, 0, h};
Point(5) = {0, 0.04, 0, h};
Point(6) = {0.04, 0.02, 0, h};  // middle of the arc: a node of no triangle
Line(1) = {1, 2};
Line(2) = {2, 3};
Circle(3) = {3, 6, 4};
Line(4) = {4, 5};
Line(5) = {5, 1};
Curve Loop(1) = {1, 2, 3, 4, 5};
Plane Surface(1) = {1};
