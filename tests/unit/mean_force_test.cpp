// Contact forces as means over a time step, and the tangent that Newton takes from the whole chain: motion, pose,
// contact search, normal and creep forces, mean over the step.

#include "railtab/runtime/contact/mean_force.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

#include "wheelset_chain.hpp"

namespace railtab {
namespace {

double power(double d, double exponent) { return d > 0.0 ? std::pow(d, exponent) : 0.0; }

TEST(HertzMeanFactor, MakesTheWorkThatOfTheEnergy) {
  for (const double d0 : {-1e-4, -1e-9, 0.0, 1e-9, 2e-5, 1e-4}) {
    for (const double d1 : {-2e-4, 0.0, 1e-7, 1.9e-5, 3e-4}) {
      if (d0 <= 0.0 && d1 <= 0.0) continue;
      const double mean = hertz_mean_factor(d0, d1) * 0.5 * (power(d0, 1.5) + power(d1, 1.5));
      EXPECT_NEAR(mean * (d1 - d0), 0.4 * (power(d1, 2.5) - power(d0, 2.5)),
                  1e-15 * power(std::max(d0, d1), 2.5) + 1e-26)
          << d0 << ' ' << d1;
      EXPECT_DOUBLE_EQ(hertz_mean_factor(d0, d1), hertz_mean_factor(d1, d0));
    }
    if (d0 <= 0.0) continue;
    EXPECT_DOUBLE_EQ(hertz_mean_factor(d0, d0), 1.0);
    EXPECT_NEAR(hertz_mean_factor(d0, 1e-15 * d0), hertz_mean_factor(d0, -1e-15 * d0), 1e-6);  // at lift-off
  }
}

struct Step {
  const char* name;
  Vector6 from, to;
};

// Penetrations follow from a search at every pose.
TEST(EquivalentDescent, ChangesTheEnergyOfPatchesAsAMotionDoes) {
  Chain chain;
  for (const double y : {0.0, 4.6e-3, 5.5e-3}) {
    const WheelsetPose from{y, 0.32e-3, 1e-3, 1e-3};
    const WheelContact contact = wheel_contact(*chain.geometry, from);
    const LoadedWheelForce force = wheel_force(
        chain.model, WheelSide::right, {.displacement = {0, from.y, from.z, from.roll, 0, from.yaw}}, {}, contact);
    const ContactMemory memory = contact_memory(chain.geometry->pair(), contact, force);
    const auto energy = [&](const WheelsetPose& pose) {
      const ContactPatches patches = chain.geometry->patches(pose);
      EXPECT_EQ(patches.count, contact.patches.count);
      double sum = 0.0;
      for (std::size_t i = 0; i < static_cast<std::size_t>(patches.count); ++i) {
        sum += force.normal[i] * patches.patch[i].penetration;
      }
      return sum;
    };
    const double h = 1e-8, per_metre = (energy({from.y, from.z + h, from.roll, from.yaw}) -
                                        energy({from.y, from.z - h, from.roll, from.yaw})) /
                                       (2.0 * h);
    EXPECT_GT(per_metre, 1e3);
    const WheelsetPose motions[] = {{0, h, 0, 0}, {h, 0, 0, 0}, {0, 0, h, 0}, {0, 0, 0, h}, {h, -h, 2 * h, h}};
    for (const WheelsetPose& m : motions) {
      const WheelsetPose to{from.y + m.y, from.z + m.z, from.roll + m.roll, from.yaw + m.yaw};
      const WheelsetPose back{from.y - m.y, from.z - m.z, from.roll - m.roll, from.yaw - m.yaw};
      const double descent = equivalent_descent(memory, force.normal, from, to);
      EXPECT_NEAR(per_metre * descent, 0.5 * (energy(to) - energy(back)), 2e-3 * per_metre * h) << y;
    }
  }
  EXPECT_EQ(equivalent_descent({}, {}, {}, {1e-3, 1e-3, 1e-3, 1e-3}), 0.0);
}

class ChainTangent : public ::testing::TestWithParam<ContactForceRule> {};

TEST_P(ChainTangent, IsThatOfTheForces) {
  const HhtScheme hht{.alpha = -0.05, .time_step = 1e-3, .contact_force = GetParam()};
  const Step steps[] = {{"tread", pose(0.0, 0.30e-3, 1e-3), pose(1e-4, 0.31e-3, 1.1e-3)},
                        {"tread and root", pose(4.6e-3, 0.32e-3, 0.0), pose(4.65e-3, 0.33e-3, 1e-4)},
                        {"flange", pose(5.5e-3, 0.30e-3, 1e-3), pose(5.6e-3, 0.31e-3, 1e-3)},
                        {"landing", pose(1e-3, 0.0, 0.0), pose(1e-3, 0.30e-3, 1e-3)},
                        {"lift-off", pose(1e-3, 0.30e-3, 0.0), pose(1e-3, 0.10e-3, 1e-3)}};
  for (const Step& step : steps) {
    Chain chain;
    chain.start.displacement.head<6>() = step.from;
    chain.problem.predicted.head<6>() = step.from;
    evaluate_contact(chain.model, chain.problem, chain.start);
    chain.problem.velocity_rate = Vector6::Constant(hht.velocity_rate());
    chain.problem.rail_velocity_rate = hht.velocity_rate();
    if (hht.contact_force == ContactForceRule::energy) {
      chain.problem.start = &chain.start;
      chain.problem.mean_weight = 1.0 / (hht.gamma() * hht.load_weight());
    }
    // What Newton makes of it before it has learnt from a correction, with no compliance at all.
    NewtonWorkspace workspace;
    chain.problem.free = Eigen::VectorXd::Zero(wheelset_unknowns);
    chain.problem.vehicle_compliance = Eigen::MatrixXd::Zero(6, 6);
    Eigen::VectorXd q = Eigen::VectorXd::Zero(wheelset_unknowns);
    q.head<6>() = step.to;
    chain.end.displacement = q;
    static_cast<void>(
        solve_contact(chain.model, chain.problem, {.tolerance = 1e-15, .max_iterations = 0}, chain.end, workspace));
    ASSERT_EQ(workspace.tangent.size(), 1u);

    const double scale_of[] = {1.0, 1.0, 1.0, 0.75, 0.46, 0.75, 1.0, 1.0, 0.1, 1.0, 1.0, 0.1};  // m per m or rad
    double largest = 0.0, stiffest = 0.0;
    for (int j = 0; j < wheelset_unknowns; ++j) {
      const double h = 2e-8;
      Eigen::VectorXd moved = q;
      moved[j] += h;
      const Eigen::VectorXd plus = chain.force_after(moved);
      moved[j] -= 2 * h;
      const Eigen::VectorXd difference = (plus - chain.force_after(moved)) / (2 * h);
      for (int i = 0; i < wheelset_unknowns; ++i) {
        const double scale = scale_of[i] * scale_of[j];
        largest = std::max(largest, std::abs(workspace.tangent[0](i, j) - difference[i]) / scale);
        stiffest = std::max(stiffest, std::abs(difference[i]) / scale);
      }
    }
    std::printf("%-14s stiffness %.2e N/m, tangent off by %.1e N/m\n", step.name, stiffest, largest);
    EXPECT_LE(largest, 2e-3 * stiffest) << step.name;
    const bool lifted = chain.end.end_force.isZero();
    EXPECT_EQ(lifted, step.to[2] < 0.2e-3) << step.name;
    const bool acts = hht.contact_force == ContactForceRule::energy || !lifted;
    EXPECT_GT(stiffest, acts ? 1e6 : -1.0) << step.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Rules, ChainTangent, ::testing::Values(ContactForceRule::endpoint, ContactForceRule::energy),
                         [](const auto& rule) {
                           return rule.param == ContactForceRule::energy ? "energy" : "endpoint";
                         });

}  // namespace
}  // namespace railtab
