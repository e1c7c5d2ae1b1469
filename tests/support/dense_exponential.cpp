#include "support/dense_exponential.hpp"

#include <Eigen/Dense>
#include <unsupported/Eigen/MatrixFunctions>

namespace rheo::test {

void exponentiate(double* a, int n) {
  Eigen::Map<Eigen::MatrixXd> matrix(a, n, n);
  matrix = matrix.exp().eval();
}

}  // namespace rheo::test
