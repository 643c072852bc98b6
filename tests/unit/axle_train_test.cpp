// Trains of axle loads: the library against its source's sums, and lists of users.
#include "railtab/runtime/moving_load/axle_train.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "../folder_fixture.hpp"
#include "railtab/runtime/base/input_error.hpp"

namespace railtab {
namespace {

/// Axles, first to last axle [m] and sum [kN] of EN 1991-2, Table 6.3, from N, D, d and P by hand.
TEST(AxleTrain, UniversalTrainsOfHslmA) {
  struct Row {
    const char* name;
    std::size_t axles;
    double reach, total;
  };
  const Row rows[] = {{"hslm-a1", 50, 397.525, 8500.0}, {"hslm-a2", 48, 398.525, 9600.0},
                      {"hslm-a3", 46, 397.525, 8280.0}, {"hslm-a4", 44, 394.525, 8360.0},
                      {"hslm-a5", 42, 389.525, 7140.0}, {"hslm-a6", 40, 382.525, 7200.0},
                      {"hslm-a7", 40, 397.525, 7600.0}, {"hslm-a8", 38, 387.525, 7220.0},
                      {"hslm-a9", 36, 375.525, 7560.0}, {"hslm-a10", 36, 388.525, 7560.0}};
  for (const Row& row : rows) {
    const AxleTrain train = find_axle_train(row.name, 25.0);
    EXPECT_EQ(train.behind.size(), row.axles) << row.name;
    EXPECT_NEAR(train.reach(), row.reach, 1e-9) << row.name;
    EXPECT_NEAR(train.total_load(), 1e3 * row.total, 1e-6) << row.name;
    EXPECT_TRUE(std::is_sorted(train.behind.begin(), train.behind.end())) << row.name;
    for (std::size_t k = 0; k < row.axles; ++k) {
      EXPECT_NEAR(train.behind[k] + train.behind[row.axles - 1 - k], row.reach, 1e-9) << row.name << ": symmetric";
    }
  }
  // A2's first axles: power car, end coach, first articulation bogie at 18.7625 + 19 ∓ 1.75
  const AxleTrain a2 = find_axle_train("hslm-a2", 25.0);
  const double first[] = {0.0, 3.0, 14.0, 17.0, 20.525, 24.025, 36.0125, 39.5125};
  for (std::size_t k = 0; k < std::size(first); ++k) EXPECT_NEAR(a2.behind[k], first[k], 1e-9);
}

TEST(AxleTrain, WagonsMayBeRepeated) {
  const AxleTrain two = find_axle_train("en15528-d2*2", 25.0);
  const double expected[] = {0.0, 1.8, 9.25, 11.05, 14.05, 15.85, 23.3, 25.1};  // 14.05 m over buffers
  ASSERT_EQ(two.behind.size(), std::size(expected));
  for (std::size_t k = 0; k < std::size(expected); ++k) EXPECT_NEAR(two.behind[k], expected[k], 1e-9);
  for (const double load : two.load) EXPECT_NEAR(load, 22.5e3 * 9.81, 1e-6);
}

/// 4 × 250 kN and 80 kN/m on one deck length beyond 3.2 m on either side; 2 × 15 m of 133 kN/m; 2 × 25 m of 150 kN/m.
TEST(AxleTrain, StaticLoadModelsWithLineLoadsAsForces) {
  const AxleTrain lm71 = find_axle_train("lm71", 20.0);
  EXPECT_TRUE(lm71.only_static);
  EXPECT_NEAR(lm71.total_load(), 4 * 250e3 + 2 * 80e3 * 20.0, 1e-3);
  EXPECT_NEAR(lm71.reach(), 2.0 * 23.2 - 0.1, 1e-9) << "from middle to middle of the outer pieces";
  EXPECT_NEAR(find_axle_train("sw/0", 20.0).total_load(), 2 * 133e3 * 15.0, 1e-3);
  EXPECT_NEAR(find_axle_train("sw/0", 20.0).reach(), 35.3 - 0.1, 1e-9);
  EXPECT_NEAR(find_axle_train("sw/2", 20.0).total_load(), 2 * 150e3 * 25.0, 1e-3);
  EXPECT_NEAR(find_axle_train("sw/2", 20.0).reach(), 57.0 - 0.1, 1e-9);
}

TEST(AxleTrain, EveryTrainHasItsSource) {
  const std::vector<std::string> names = train_names();
  EXPECT_EQ(names.size(), 25U);
  for (const std::string& name : names) {
    const AxleTrain train = find_axle_train(name, 10.0);
    EXPECT_FALSE(train.provenance.source.empty()) << name;
    EXPECT_EQ(train.provenance.standing == Standing::assumed, train.only_static) << name << ": from memory";
  }
  EXPECT_EQ(expanded_names({"hslm-a", "lm71"}).size(), 11U);
}

class AxleFile : public testing::InFolder {
 protected:
  void expect_rejected(const std::string& text, const std::string& part) const {
    try {
      static_cast<void>(read_axle_file(write("axles.csv", text)));
      FAIL() << text;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  }
};

TEST_F(AxleFile, AListOfAxles) {
  const AxleTrain train =
      find_axle_train(write("tram.csv", "# a tram\nx[m],P[kN]\n1.0,80\n2.8,80\n9,100.5\n").string(), 25.0);
  EXPECT_EQ(train.name, "tram");
  ASSERT_EQ(train.behind.size(), 3U);
  EXPECT_EQ(train.behind[0], 0.0);
  EXPECT_NEAR(train.behind[1], 1.8, 1e-12);
  EXPECT_NEAR(train.behind[2], 8.0, 1e-12);
  EXPECT_EQ(train.load, (std::vector<double>{80e3, 80e3, 100.5e3}));
}

TEST_F(AxleFile, WrongListsNameTheirLine) {
  expect_rejected("x[m],P[kN]\n0,80\n3,80\n2,80\n", "axles.csv:4: x[m]: found 2 after 3");
  expect_rejected("x[m],P[kN]\n0,80\n3,0\n", "axles.csv:3: P[kN]: found 0");
  expect_rejected("x[m],P[kN]\n0,80000\n", "axles.csv:2: P[kN]: found 80000");
  expect_rejected("x[m],P[kN]\n0,80\n18000,80\n", "axles.csv:3: x[m]: found 18000 m");
  expect_rejected("x[m],P[kN]\n0,heavy\n", "axles.csv:2");
  expect_rejected("x,P\n0,80\n", "axles.csv:1");
}

TEST(AxleTrain, WrongNames) {
  const auto message = [](const std::string& name) -> std::string {
    try {
      static_cast<void>(find_axle_train(name, 25.0));
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message("hslm-a11").find("'hslm-a11'"), std::string::npos);
  EXPECT_NE(message("hslm-a11").find("hslm-a10"), std::string::npos) << "the known ones";
  EXPECT_NE(message("en15528-d2*0").find("N from 1"), std::string::npos);
  EXPECT_NE(message("en15528-d2*six").find("N from 1"), std::string::npos);
  EXPECT_NE(message("hslm-a1*2").find("once"), std::string::npos);
  EXPECT_NE(message("none.csv").find("none.csv"), std::string::npos);
}

}  // namespace
}  // namespace railtab
