#include "node_scalars.hpp"

#include <cmath>

namespace app {
namespace {

double length(std::span<const double> field, std::size_t i) {
  return std::hypot(field[2 * i], field[2 * i + 1]);
}

}  // namespace

void find_scalars(const rheo::Simulation& simulation, rheo::ColorBy color, int branch,
                  std::span<double> out) {
  const auto number = static_cast<std::size_t>(branch - 1);
  const auto lambda = branch == 0 ? simulation.w_lambda() : simulation.w_lambda(number);
  const auto mu = branch == 0 ? simulation.w_mu() : simulation.w_mu(number);
  const auto v = simulation.v();
  for (std::size_t i = 0; i < out.size(); ++i) {
    switch (color) {
      case rheo::ColorBy::w_lambda:
        out[i] = length(lambda, i);
        break;
      case rheo::ColorBy::w_mu:
        out[i] = length(mu, i);
        break;
      case rheo::ColorBy::w:
        out[i] = std::hypot(length(lambda, i), length(mu, i));
        break;
      case rheo::ColorBy::speed:
        out[i] = length(v, i);
        break;
      case rheo::ColorBy::none:
        out[i] = 0.0;
        break;
    }
  }
}

ScalarText scalar_text(rheo::ColorBy color, int branch) {
  const std::string of = branch > 0 ? " (" + std::to_string(branch) + ")" : "";
  switch (color) {
    case rheo::ColorBy::w_lambda:
      return {"|w_lambda|" + of, "Pa m"};
    case rheo::ColorBy::w_mu:
      return {"|w_mu|" + of, "Pa m"};
    case rheo::ColorBy::w:
      return {"|w|" + of, "Pa m"};
    case rheo::ColorBy::speed:
      return {"speed |v|", "m/s"};
    case rheo::ColorBy::none:
      break;
  }
  return {};
}

}  // namespace app
