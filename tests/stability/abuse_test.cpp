// A user at his worst, by program: parameters that jump over decades between frames, pushes that turn round
// every tick or every step, hands that grab and let go while parameters change. Every state is finite,
// nothing is taken for a divergence, and kinetic + stored + dissipated - work is one number from the first
// tick to the last: what a change of parameters makes the energies jump by is work of the change.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include "support/live_scenes.hpp"

namespace rheo::test {
namespace {

class Draw {
 public:
  explicit Draw(unsigned seed) : random_(seed) {}
  double unit() { return std::uniform_real_distribution<double>(0.0, 1.0)(random_); }
  double decades(double low, double high) { return low * std::pow(high / low, unit()); }
  bool chance(double p) { return unit() < p; }
  double sign() { return chance(0.5) ? 1.0 : -1.0; }

 private:
  std::mt19937 random_;
};

struct Abused {
  const char* name;
  Mass mass;
  Kernel kernel;
  IntegratorKind integrator;
  bool tied = false;  // by a [[constraint]]
  bool many_parts = false;
};

void PrintTo(const Abused& each, std::ostream* out) {
  *out << each.name;
}

// Some of the parameters jump: moduli over five decades, relaxation times over seven, density over three.
void jump(Draw& draw, Scene& scene) {
  Material& m = scene.material;
  if (draw.chance(0.5)) {
    const double time = m.lambda_vis / m.lambda_ela;
    m.lambda_ela = draw.decades(1.0, 1e5);
    m.lambda_vis = m.lambda_ela * time;
  }
  if (draw.chance(0.5)) {
    const double time = m.mu_vis / m.mu_ela;
    m.mu_ela = draw.decades(1.0, 1e5);
    m.mu_vis = m.mu_ela * time;
  }
  if (draw.chance(0.4)) m.lambda_vis = m.lambda_ela * draw.decades(1e-4, 1e3);
  if (draw.chance(0.4)) m.mu_vis = m.mu_ela * draw.decades(1e-4, 1e3);
  if (draw.chance(0.3)) m.density = draw.decades(30.0, 3e4);
  if (draw.chance(0.3)) scene.time.baumgarte = draw.decades(0.1, 1e3);
  for (MaxwellBranch& b : m.more_branches) {
    if (draw.chance(0.3)) b.mu_ela = draw.decades(1.0, 1e5), b.mu_vis = b.mu_ela * draw.decades(1e-4, 1e3);
  }
  if (m.elastic.mu > 0.0 && draw.chance(0.3)) m.elastic = {draw.decades(1.0, 1e4), draw.decades(1.0, 1e4)};
  if (m.viscous.mu > 0.0 && draw.chance(0.3))
    m.viscous = {draw.decades(1e-2, 10.0), draw.decades(1e-2, 10.0)};
}

double held_energy(const Energies& e) {
  return e.kinetic + e.stored;
}
double balance(const Energies& e) {
  return e.kinetic + e.stored + e.dissipated - e.work;
}

bool is_finite(const Simulation& s) {
  const auto all = [](std::span<const double> x) {
    return std::all_of(x.begin(), x.end(), [](double value) { return std::isfinite(value); });
  };
  return all(s.u()) && all(s.v()) && all(s.w_lambda()) && all(s.w_mu());
}

class Abuse : public testing::TestWithParam<Abused> {};

TEST_P(Abuse, LeavesEveryStateFiniteAndEveryEnergyAccounted) {
  const Abused& each = GetParam();
#if defined(RHEO_SANITIZE_ADDRESS) || defined(RHEO_SANITIZE_THREAD)
  const int ticks = 120;
#else
  const int ticks = 600;
#endif
  // Too large for all eigenvalues at every change of parameters.
  Scene scene = live_block(each.mass, 8, 5);
  scene.time.step = 0.0;
  scene.time.integrator = each.integrator;
  if (each.tied) scene.constraints.push_back({{{19, Axis::x, 1.0}, {20, Axis::x, -1.0}}, 0.0, "tie"});
  if (each.many_parts) {
    Material& m = scene.material;
    m.more_branches.push_back({0.0, m.mu_ela, forever, 0.2 * m.mu_vis});
    m.elastic = {0.5 * m.lambda_ela, 0.5 * m.mu_ela};
    m.viscous = {1e-3 * m.lambda_ela, 1e-3 * m.mu_ela};
  }
  LiveSettings settings = live_settings(scene);
  settings.record = 0;
  settings.simulation.kernel = each.kernel;
  settings.simulation.stable_share = 0.1;
  settings.simulation.threads = 1;
  const bool knows_energies = each.integrator == IntegratorKind::rk4;
  auto live = std::make_unique<Live>(scene, settings);
  Draw draw(11);
  double push = 1.0, worst = 0.0, worst_jump = 0.0;
  int jumps = 0, grabs = 0;
  for (int k = 0; k < ticks; ++k) {
    const Energies before = live->simulation().energies();
    if (draw.chance(0.25)) {
      jump(draw, scene);
      const bool grabbed = live->is_grabbed(grab_handle);
      SavedState saved = live->simulation().save();
      saved.energies = before;
      live = std::make_unique<Live>(scene, settings, saved);
      ++jumps;
      if (grabbed && draw.chance(0.7)) live->grab(grab_handle);
      const Energies after = live->simulation().energies();
      ASSERT_TRUE(is_finite(live->simulation()));
      if (knows_energies) {
        const double size =
            std::max(held_energy(before), held_energy(after)) + std::abs(before.work) + before.dissipated;
        worst_jump = std::max(worst_jump, std::abs(balance(after) - balance(before)) / size);
      }
    }
    if (draw.chance(0.2)) push = draw.decades(0.1, 1e3);
    live->push(push_handle, {0.3 * push, k % 2 == 0 ? push : -push});
    if (draw.chance(0.15)) grabs += live->grab(grab_handle) > 0;
    if (draw.chance(0.15)) live->release(grab_handle);
    if (draw.chance(0.3))
      live->drag(grab_handle,
                 {draw.sign() * draw.decades(1e-6, 3e-3), draw.sign() * draw.decades(1e-6, 3e-3)});
    const Energies start = live->simulation().energies();
    const auto diverged = live->tick();
    ASSERT_FALSE(diverged) << "tick " << k << ": energy " << diverged->energy << " of " << diverged->allowed;
    ASSERT_TRUE(is_finite(live->simulation())) << "tick " << k;
    if (!knows_energies) continue;
    const Energies now = live->simulation().energies();
    // What went through the body in this tick and what it holds.
    const double size = std::max(held_energy(start), held_energy(now)) + std::abs(now.work - start.work) +
                        (now.dissipated - start.dissipated);
    worst = std::max(worst, std::abs(balance(now) - balance(start)) / size);
  }
  EXPECT_GT(jumps, ticks / 6);
  EXPECT_GT(grabs, ticks / 40);
  std::printf("%s: worst of a tick %.2e, of a jump %.2e\n", each.name, worst, worst_jump);
  EXPECT_LE(worst_jump, 1e-12) << "of a jump";
  EXPECT_LE(worst, 1e-3) << "of a tick, by steps of a tenth of the limit";
}

INSTANTIATE_TEST_SUITE_P(
    All, Abuse,
    testing::Values(Abused{"edge", Mass::lumped, Kernel::edge, IntegratorKind::rk4},
                    Abused{"element", Mass::lumped, Kernel::element, IntegratorKind::rk4},
                    Abused{"csr_consistent", Mass::consistent, Kernel::csr, IntegratorKind::rk4},
                    Abused{"tied", Mass::lumped, Kernel::csr, IntegratorKind::rk4, true},
                    Abused{"many_parts", Mass::lumped, Kernel::edge, IntegratorKind::rk4, false, true},
                    Abused{"exponential", Mass::lumped, Kernel::edge, IntegratorKind::exponential},
                    Abused{"implicit", Mass::lumped, Kernel::csr, IntegratorKind::implicit},
                    Abused{"implicit_tied", Mass::consistent, Kernel::csr, IntegratorKind::implicit, true}),
    [](const auto& i) { return i.param.name; });

// A push that turns round every step, as long as the limit allows: nothing resounds without bound.
TEST(AbuseOfSteps, APushThatTurnsRoundEveryStepDoesNotPumpTheBody) {
  for (const double share : {0.3, 0.6, 0.99}) {
    Scene scene = live_block(Mass::lumped, 6, 4);
    scene.fixes.resize(1);
    scene.tractions.clear();
    scene.body_acceleration = {};
    scene.time.step = 0.0;
    LiveSettings settings = live_settings(scene);
    settings.record = 0;
    settings.rate = 1.0 / (share * Simulation(scene).stable_step());
    settings.simulation.stable_share = 1.0;
    Live live(scene, settings);
    double first = 0.0, last = 0.0;
    constexpr int ticks = 20000;
    for (int k = 0; k < ticks; ++k) {
      live.push(push_handle, {0.0, k % 2 == 0 ? 100.0 : -100.0});
      ASSERT_FALSE(live.tick()) << share << ", step " << k;
      const Energies e = live.simulation().energies();
      ASSERT_TRUE(std::isfinite(held_energy(e)));
      (k < ticks / 2 ? first : last) = std::max(k < ticks / 2 ? first : last, held_energy(e));
    }
    EXPECT_EQ(live.simulation().counters().steps, ticks);
    EXPECT_GT(first, 0.0);
    EXPECT_LE(last, first) << share;
  }
}

}  // namespace
}  // namespace rheo::test
