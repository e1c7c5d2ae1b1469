// Two physical surfaces, one named, one with a number only, over three plane surfaces; and a third group over
// all of them.
SetFactory("Built-in");
h = 0.01;
Point(1) = {0, 0, 0, h}; Point(2) = {0.04, 0, 0, h}; Point(3) = {0.04, 0.01, 0, h}; Point(4) = {0, 0.01, 0, h};
Point(5) = {0.04, 0.03, 0, h}; Point(6) = {0, 0.03, 0, h}; Point(7) = {0.04, 0.04, 0, h}; Point(8) = {0, 0.04, 0, h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Line(5) = {3, 5}; Line(6) = {5, 6}; Line(7) = {6, 4};
Line(8) = {5, 7}; Line(9) = {7, 8}; Line(10) = {8, 6};
Line Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Line Loop(2) = {-3, 5, 6, 7}; Plane Surface(2) = {2};
Line Loop(3) = {-6, 8, 9, 10}; Plane Surface(3) = {3};
Physical Surface("crust", 31) = {1, 3};
Physical Surface(32) = {2};
Physical Surface("upper", 33) = {2, 3};
Physical Curve("base", 34) = {1};
