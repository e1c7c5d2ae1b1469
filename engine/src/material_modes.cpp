#include "material_modes.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "mode_root.hpp"

namespace rheo {
namespace {

// A direction in the cone: springs by the index of their rate, and the dashpots.
struct Ray {
  Eigen::VectorXd springs;
  double dashpots = 0.0;
};

class MaterialModes {
 public:
  explicit MaterialModes(const Spectrum& spectrum) : spectrum_(spectrum) {
    for (const Relaxation& each : spectrum.relaxations) rates_.push_back(each.rate);
    for (const Spectrum::Part& part : spectrum.materials) {
      const auto add = [&](double a) {
        Ray ray{Eigen::VectorXd::Zero(static_cast<Eigen::Index>(rates_.size())),
                a * part.viscous.lambda + part.viscous.mu};
        for (const Relaxation& each : part.relaxations)
          ray.springs[index_of(each.rate)] += a * each.moduli.lambda + each.moduli.mu;
        if (ray.springs.sum() > 0.0 || ray.dashpots > 0.0) rays_.push_back(std::move(ray));
      };
      add(1.0);
      add(0.0);
    }
  }

  double limit() {
    if (spectrum_.viscous_max <= 0.0) return limit_under(1.0);
    double best = 0.0;
    for (const double theta : {0.05, 0.5, 0.95}) best = std::max(best, limit_under(theta));
    return best;
  }

 private:
  // The rates of all materials are there, but for rounding.
  Eigen::Index index_of(double rate) const {
    const auto nearest = std::min_element(rates_.begin(), rates_.end(), [&](double a, double b) {
      return std::abs(a - rate) < std::abs(b - rate);
    });
    return nearest - rates_.begin();
  }

  double limit_under(double theta) {
    step_ = std::numeric_limits<double>::infinity();
    for (const double rate : rates_)
      if (rate > 0.0) take(-rate);
    std::vector<Ray> unit;
    for (Ray ray : rays_) {
      // Where nothing can move, nothing is stretched either.
      if (!(spectrum_.omega_max > 0.0)) ray.springs.setZero();
      if (!(spectrum_.viscous_max > 0.0)) ray.dashpots = 0.0;
      double size = 0.0;
      if (spectrum_.omega_max > 0.0)
        size += theta * ray.springs.sum() / (spectrum_.omega_max * spectrum_.omega_max);
      if (theta < 1.0) size += (1.0 - theta) * ray.dashpots / spectrum_.viscous_max;
      if (!(size > 0.0)) continue;
      ray.springs /= size;
      ray.dashpots /= size;
      unit.push_back(std::move(ray));
    }
    for (std::size_t i = 0; i < unit.size() && step_ > 0.0; ++i) {
      magnitudes(unit[i]);
      for (std::size_t j = i + 1; j < unit.size(); ++j) {
        for (int k = 1; k < shares; ++k) {
          const double share = static_cast<double>(k) / shares;
          magnitudes({share * unit[i].springs + (1.0 - share) * unit[j].springs,
                      share * unit[i].dashpots + (1.0 - share) * unit[j].dashpots});
        }
      }
    }
    return step_;
  }

  // From the largest down: the limit only grows, but for little.
  void magnitudes(const Ray& largest) {
    const double fastest =
        std::max({rates_.empty() ? 0.0 : rates_.back(), largest.dashpots, std::sqrt(largest.springs.sum())});
    for (int half_octaves = 0; half_octaves < 12; ++half_octaves) {
      const double part = std::exp2(-half_octaves / 2.0);
      if (half_octaves > 0 &&
          part * std::max(largest.dashpots, std::sqrt(largest.springs.sum())) < 0.02 * fastest)
        return;
      include({part * part * largest.springs, part * largest.dashpots});
    }
  }

  void include(const Ray& mode) {
    used_.clear();
    for (Eigen::Index k = 0; k < mode.springs.size(); ++k)
      if (mode.springs[k] > 0.0) used_.push_back({mode.springs[k], rates_[static_cast<std::size_t>(k)]});
    const auto n = static_cast<Eigen::Index>(used_.size());
    Eigen::MatrixXd m = Eigen::MatrixXd::Zero(1 + n, 1 + n);  // on v and sqrt(spring) q of each rate
    m(0, 0) = -mode.dashpots;
    for (Eigen::Index i = 0; i < n; ++i) {
      const ModeSpring& spring = used_[static_cast<std::size_t>(i)];
      m(0, 1 + i) = -std::sqrt(spring.stiffness);
      m(1 + i, 0) = -m(0, 1 + i);
      m(1 + i, 1 + i) = -spring.rate;
    }
    const double size = m.cwiseAbs().maxCoeff();
    solver_.compute(m, false);
    for (const std::complex<double> s : solver_.eigenvalues()) {
      if (std::abs(s) > 1e-13 * size) take(sharpened_root(s, used_, mode.dashpots));
    }
  }

  void take(std::complex<double> s) { step_ = std::min(step_, stable_step_of(s, IntegratorKind::euler)); }

  static constexpr int shares = 16;
  const Spectrum& spectrum_;
  std::vector<double> rates_;  // rising
  std::vector<Ray> rays_;
  std::vector<ModeSpring> used_;
  Eigen::EigenSolver<Eigen::MatrixXd> solver_;
  double step_ = 0.0;
};

}  // namespace

double euler_step_of_materials(const Spectrum& spectrum) {
  return MaterialModes(spectrum).limit();
}

}  // namespace rheo
