#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "../measured.hpp"
#include "../reference_table.hpp"
#include "railtab/tablegen/rolling_contact.hpp"

namespace railtab {
namespace {

struct ErrorStatistics {
  double mean, p95, max;
};

ErrorStatistics statistics(const std::string& name, std::vector<double> e) {
  std::sort(e.begin(), e.end());
  double sum = 0.0;
  for (const double v : e) sum += v;
  const ErrorStatistics s{sum / static_cast<double>(e.size()), e[e.size() * 95 / 100], e.back()};
  testing::measured(name + ".mean", s.mean);
  testing::measured(name + ".p95", s.p95);
  testing::measured(name + ".max", s.max);
  return s;
}

struct Errors {
  ErrorStatistics force, moment;
};

/// Error of the force vector in units of μF_n and of the moment in units of μF_n √(ab), against a reference file.
template <class Solve>
Errors errors(const std::string& file, const std::string& name, const Solve& solve) {
  auto t = testing::read_reference(file);
  std::vector<double> force, moment;
  for (std::size_t i = 0; i < t["ratio"].size(); ++i) {
    const CreepForce f = solve(t["ratio"][i], Creepage{t["ux"][i], t["uy"][i], t["phi"][i]});
    force.push_back(std::hypot(f.x - t["fx"][i], f.y - t["fy"][i]));
    moment.push_back(std::abs(f.moment - t["mz"][i]));
  }
  return {statistics("rolling." + name + ".force", force), statistics("rolling." + name + ".moment", moment)};
}

CreepForce on_elements(double ratio, const Creepage& creepage) {
  const RollingContactSolution s = RollingContact(ratio, 0.28).solve(creepage);
  EXPECT_TRUE(s.converged && !s.safe_method);
  return s.force;
}

CreepForce extrapolated(double ratio, const Creepage& creepage) {
  const ExtrapolatedContactSolution s = ExtrapolatedRollingContact(ratio, 0.28).solve(creepage);
  EXPECT_TRUE(s.coarse.converged && s.fine.converged && !s.coarse.safe_method && !s.fine.safe_method);
  return s.force;
}

TEST(RollingContactReference, OnTheElementsOfContact) {
  // What remains is the pressure: CONTACT solves for it on the same elements, here it is Hertz's at their centres.
  const Errors e = errors("creep_exact_40.csv", "elements", on_elements);
  EXPECT_LT(e.force.mean, 0.0005);
  EXPECT_LT(e.force.max, 0.004);
}

TEST(RollingContactReference, ExtrapolatedAgainstTheLimitOfSmallElements) {
  const Errors plain = errors("creep_exact_limit.csv", "plain_limit", on_elements);
  const Errors e = errors("creep_exact_limit.csv", "limit", extrapolated);
  EXPECT_LT(e.force.mean, 0.001);
  EXPECT_LT(e.force.max, 0.005);
  EXPECT_LT(e.force.mean, 0.4 * plain.force.mean);
}

TEST(RollingContactReference, ExtrapolatedAgainstFineElements) {
  // The reference's own 120 x 120 elements are a third of the 40 x 40 error away from the limit, some 0.0013.
  const Errors e = errors("creep_exact.csv", "fine", extrapolated);
  EXPECT_LT(e.force.mean, 0.002);
  EXPECT_LT(e.force.max, 0.008);
}

TEST(RollingContactReference, ErrorOfTheElementsIsOfFirstOrder) {
  // c11 and c22 at both ends and the middle: twice the elements, half the error, not better and not worse.
  auto t = testing::read_reference("creep_cij.csv");
  int checked = 0;
  for (std::size_t i = 0; i < t["ratio"].size(); ++i) {
    const double ratio = t["ratio"][i];
    if (t["nu"][i] != 0.28 || (ratio != 0.1 && ratio != 1.0 && ratio != 5.0)) continue;
    double error[2][2];
    for (const int k : {0, 1}) {
      RollingContactOptions options;
      options.elements = k == 0 ? 20 : 40;
      options.size = RollingContactOptions::ElementSize::equal_area;
      RollingContact contact(ratio, 0.28, options);
      error[k][0] = -contact.solve({1e-6, 0, 0}).force.x * 1e6 / t["c11"][i] - 1.0;
      error[k][1] = -contact.solve({0, 1e-6, 0}).force.y * 1e6 / t["c22"][i] - 1.0;
    }
    for (const int c : {0, 1}) {
      EXPECT_GT(error[0][c] / error[1][c], 1.7) << ratio;
      EXPECT_LT(error[0][c] / error[1][c], 2.3) << ratio;
    }
    ++checked;
  }
  EXPECT_EQ(checked, 3);
}

struct Coefficients {
  double c11, c22, c23, c33;
};

/// Kalker's coefficients in the limit of small elements: a straight line in 1/n through grids of many sizes, so that
/// the ragged edge of each averages out.
Coefficients limit_coefficients(double ratio, double nu) {
  double weight = 0.0, h_sum = 0.0, hh_sum = 0.0;
  double sum[4] = {}, h_times[4] = {};
  for (int n = 40; n <= 120; n += 8) {
    RollingContactOptions options;
    options.elements = n;
    options.size = RollingContactOptions::ElementSize::equal_area;
    RollingContact contact(ratio, nu, options);
    const CreepForce spin = contact.solve({0, 0, 1e-6}).force;
    const double value[4] = {-1e6 * contact.solve({1e-6, 0, 0}).force.x, -1e6 * contact.solve({0, 1e-6, 0}).force.y,
                             -1e6 * spin.y, -1e6 * spin.moment};
    const double h = 1.0 / n;
    weight += 1.0;
    h_sum += h;
    hh_sum += h * h;
    for (int c = 0; c < 4; ++c) {
      sum[c] += value[c];
      h_times[c] += h * value[c];
    }
  }
  const auto at_zero = [&](int c) {
    return (hh_sum * sum[c] - h_sum * h_times[c]) / (weight * hh_sum - h_sum * h_sum);
  };
  return {at_zero(0), at_zero(1), at_zero(2), at_zero(3)};
}

TEST(RollingContactReference, KalkerCoefficients) {
  auto t = testing::read_reference("creep_cij.csv");
  int checked = 0;
  double c11_c22 = 0.0, c23 = 0.0, c33 = 0.0;
  for (std::size_t i = 0; i < t["ratio"].size(); ++i) {
    const double ratio = t["ratio"][i];
    const bool wanted = ratio == 0.1 || ratio == 0.5 || ratio == 1.0 || ratio == 2.0 || ratio == 10.0;
    if (t["nu"][i] != 0.28 || !wanted) continue;
    const Coefficients c = limit_coefficients(ratio, 0.28);
    const double d11 = c.c11 / t["c11"][i] - 1.0, d22 = c.c22 / t["c22"][i] - 1.0;
    const double d23 = c.c23 / t["c23"][i] - 1.0, d33 = c.c33 / t["c33"][i] - 1.0;
    c11_c22 = std::max({c11_c22, std::abs(d11), std::abs(d22)});
    c23 = std::max(c23, std::abs(d23));
    c33 = std::max(c33, std::abs(d33));
    EXPECT_LT(std::abs(d11), 0.005) << ratio;
    EXPECT_LT(std::abs(d22), 0.005) << ratio;
    EXPECT_LT(std::abs(d23), 0.005) << ratio;
    EXPECT_LT(std::abs(d33), 0.005) << ratio;
    ++checked;
  }
  EXPECT_EQ(checked, 5);
  testing::measured("rolling.c11_c22_percent", 100.0 * c11_c22);
  testing::measured("rolling.c23_percent", 100.0 * c23);
  testing::measured("rolling.c33_percent", 100.0 * c33);
}

}  // namespace
}  // namespace railtab
