#include "rigid_motions.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

namespace rheo {

int rigid_motions(const Mesh& mesh, const ConstraintSolver& solver) {
  constexpr int many = 30;
  const int pieces = piece_count(mesh);
  if (pieces > many) return -1;
  std::vector<int> piece = pieces_of(mesh);  // by their lowest nodes; then by numbers
  int seen = 0;
  for (std::size_t node = 0; node < piece.size(); ++node) {
    const bool is_lowest = piece[node] == static_cast<int>(node);
    piece[node] = is_lowest ? seen++ : piece[static_cast<std::size_t>(piece[node])];
  }
  Vec2 low = mesh.points[0], high = low;
  for (const Vec2& p : mesh.points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  const double size = std::max(high.x - low.x, high.y - low.y);
  std::vector<Vec2> middle(static_cast<std::size_t>(pieces));
  std::vector<double> nodes(static_cast<std::size_t>(pieces), 0.0);
  for (std::size_t node = 0; node < piece.size(); ++node) {
    const auto k = static_cast<std::size_t>(piece[node]);
    middle[k].x += mesh.points[node].x, middle[k].y += mesh.points[node].y;
    nodes[k] += 1.0;
  }
  // What a degree of freedom does in each motion, times a coefficient, on top of a row.
  const auto add = [&](Eigen::MatrixXd& rows, Eigen::Index row, std::size_t dof, double coefficient) {
    const auto k = static_cast<std::size_t>(piece[dof / 2]);
    const Vec2& p = mesh.points[dof / 2];
    const auto at = static_cast<Eigen::Index>(3 * k);
    rows(row, at + (dof % 2 == 0 ? 0 : 1)) += coefficient;
    rows(row, at + 2) +=
        coefficient * (dof % 2 == 0 ? middle[k].y / nodes[k] - p.y : p.x - middle[k].x / nodes[k]) / size;
  };
  std::vector<std::size_t> held;
  for (std::size_t dof = 0; dof < 2 * mesh.points.size(); ++dof)
    if (!solver.is_free(dof)) held.push_back(dof);
  const auto count = static_cast<Eigen::Index>(held.size() + solver.columns().size());
  const Eigen::Index motions = 3 * pieces;
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(std::max(count, motions), motions);
  Eigen::Index row = 0;
  for (const std::size_t dof : held) add(rows, row++, dof, 1.0);
  for (const Column& column : solver.columns()) {
    double square = 0.0;
    for (const auto& [dof, coefficient] : column.entries) square += coefficient * coefficient;
    for (const auto& [dof, coefficient] : column.entries)
      add(rows, row, static_cast<std::size_t>(dof), coefficient / std::sqrt(square));
    ++row;
  }
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(rows);
  const Eigen::MatrixXd top = qr.matrixQR().topRows(motions).triangularView<Eigen::Upper>();
  const Eigen::VectorXd values = Eigen::JacobiSVD<Eigen::MatrixXd>(top).singularValues();
  return static_cast<int>((values.array() <= 1e-14 * std::max(1.0, values[0])).count());
}

}  // namespace rheo
