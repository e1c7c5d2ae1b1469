// exp(A) of a dense matrix, by Padé approximants after scaling and squaring (Eigen's).
//
// A library of its own that no sanitizer slows: dense matrices are most of the tests' work, and Eigen's loops
// over them are not what is looked at. Nothing but numbers passes its border, so that memory of one side is
// never freed by the other.
//
// Shapes   a: n x n, by columns; replaced by its exponential
#pragma once

namespace rheo::test {

__attribute__((visibility("default"))) void exponentiate(double* a, int n);

}  // namespace rheo::test
