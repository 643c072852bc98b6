// A coach on ballasted track over the deck of shells. At rest CalculiX has all of it in elements of its own: deck,
// ballast, sleepers, pads, rails, and the coach on its springs; it knows of railtab's track and coach only the data,
// and how a deck bears the ballast. In motion CalculiX has the deck, under the ballast's forces of railtab's run.
// Skipped where there is no ccx.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "../measured.hpp"
#include "ballast_forces.hpp"
#include "calculix_parts.hpp"
#include "railtab/runtime/profile/standard_profiles.hpp"
#include "railtab/runtime/start/static_equilibrium.hpp"
#include "railtab/runtime/vehicle/vehicle_library.hpp"
#include "railtab/runtime/vsi/simulation.hpp"
#include "shell_deck.hpp"

namespace railtab {
namespace {

using calculix::Body;
using calculix::Parts;
using calculix::Rail;
using calculix::Sum;

/// What a run has of the deck, step by step.
struct Crossing {
  std::vector<Eigen::VectorXd> channels;
  std::vector<std::vector<BallastForces::Force>> ballast;  // left and right of sleeper 0, of sleeper 1, …
};

class CoachOnShellDeck : public ShellDeck {
 protected:
  static void expect_as_calculix(const std::string& name, const DeckDifference& all) {
    testing::measured(name + "_edge", all.edge.percent());
    testing::measured(name + "_edge_mm", 1e3 * all.edge.largest);
    testing::measured(name + "_twist", all.twist.percent());
    testing::measured(name + "_twist_mm", 1e3 * all.twist.largest);
    testing::measured(name + "_roll", all.roll.percent());
    testing::measured(name + "_roll_mrad", 1e3 * all.roll.largest);
    EXPECT_GT(all.edge.largest, 2e-3);
    EXPECT_LT(all.edge.percent(), 0.2);
    EXPECT_LT(all.twist.percent(), 0.2);
    EXPECT_LT(all.roll.percent(), 0.2);
  }

  const CoachParameters coach = coach_parameters("manchester-coach");
  static constexpr std::array<double, 2> sides{1.0, -1.0};  // of y in CalculiX: left, right

  [[nodiscard]] static TrackParameters ballasted_track() {
    TrackParameters rails;
    rails.length_before = 33.0;
    rails.length_after = 12.0;
    return rails;
  }
  /// From the coach's centre, the front one first [m].
  [[nodiscard]] std::array<double, 4> wheelset_places() const {
    const double a = coach.half_bogie_distance, b = coach.half_wheelbase;
    return {a + b, a - b, b - a, -a - b};
  }
  [[nodiscard]] VsiModel on_rails(StructureModel structure, double centre, double speed) const {
    VsiModel model;
    model.vehicle = build_coach(coach);
    model.vehicle_x = {centre};
    model.geometry = std::make_shared<const ContactGeometry>(
        ContactSearch(WheelRailPair(ProfileCurve(standard_profile(ProfileKind::wheel, "S1002", 0.0)),
                                    ProfileCurve(standard_profile(ProfileKind::rail, "60E1", 1.0 / 40.0)), {})));
    model.contact.geometry = model.geometry.get();
    model.contact.speed = speed;
    model.structure = share(std::move(structure));
    return model;
  }

  struct AtRest {
    std::map<int, double> down;                 // of the deck's nodes [m]
    std::vector<std::array<double, 2>> wheels;  // Q left and right of each wheelset [N]
    std::vector<std::array<double, 2>> rails;   // under them, down [m]
  };
  [[nodiscard]] AtRest calculix_at_rest(const TrackParameters& t, double centre) const;
  [[nodiscard]] std::vector<std::map<int, double>> calculix_in_motion(const Crossing& crossing, double time_step,
                                                                      const TrackParameters& t) const;
  static constexpr std::size_t every = 40;  // steps between the instants of calculix_in_motion()

 private:
  /// Springs of the suspension between wheelsets and bogies: below and above, left and right.
  using Primary = std::vector<std::array<std::pair<int, int>, 2>>;
  struct PointLoad {
    int point, dof;
    std::vector<double> force;  // at every step [N]
  };

  [[nodiscard]] static int ballast_on_deck(int i, int j, double height, Parts& parts);
  [[nodiscard]] static std::array<Rail, 2> lay_track(const TrackParameters& t, const std::vector<double>& wheel_x,
                                                     Parts& parts);
  [[nodiscard]] Primary stand_coach(const std::array<Rail, 2>& rails, double half_rail_distance, double centre,
                                    Parts& parts, std::string& loads) const;
  [[nodiscard]] std::vector<double> eigenvalues(const std::string& name) const;
  static constexpr int modes = 60;
};

/// Where the ballast under one side of a sleeper begins, `height` above the middle of the shells: motion of the nodes
/// that share its force, and rotation of the deck around it.
int CoachOnShellDeck::ballast_on_deck(int i, int j, double height, Parts& parts) {
  std::array<Sum, 3> motion;
  for (const auto& [n, share] : spread(i, j)) {
    for (int k = 0; k < 3; ++k) motion[static_cast<std::size_t>(k)].push_back({n, k + 1, share});
  }
  const auto subtract_slope = [&](Sum& sum, std::array<int, 2> from, std::array<int, 2> to, double distance) {
    for (const auto& [node, sign] : {std::pair{from, 1.0}, std::pair{to, -1.0}}) {
      if (!is_support(node[0], node[1])) sum.push_back({number(node[0], node[1]), 3, sign * height / distance});
    }
  };
  const int back = std::max(0, i - 1), ahead = std::min(along, i + 1), beside = 2;
  subtract_slope(motion[0], {back, j}, {ahead, j}, bay * (ahead - back));
  subtract_slope(motion[1], {i, j - beside}, {i, j + beside}, 2 * beside * dy);
  return parts.point(motion);
}

/// Rails, pads, sleepers and ballast. A rail has its area and vertical bending; aside it bears nothing here.
std::array<Rail, 2> CoachOnShellDeck::lay_track(const TrackParameters& t, const std::vector<double>& wheel_x,
                                                Parts& parts) {
  const int first = static_cast<int>(std::lround(-t.length_before / bay));
  const int last = along + static_cast<int>(std::lround(t.length_after / bay));
  std::array<Rail, 2> rails;
  for (std::size_t s = 0; s < 2; ++s) {
    Rail& rail = rails[s];
    rail.x = wheel_x;
    for (int i = first; i <= last; ++i) rail.x.push_back(bay * i);
    std::sort(rail.x.begin(), rail.x.end());
    const auto same = [](double a, double b) { return b - a < 1e-6; };  // a wheel above a sleeper
    rail.x.erase(std::unique(rail.x.begin(), rail.x.end(), same), rail.x.end());
    for (const double x : rail.x) {
      const bool end = x == rail.x.front() || x == rail.x.back();
      rail.node.push_back(parts.node(end ? std::vector{1, 4} : std::vector<int>{},
                                     {x, track + sides[s] * t.half_rail_distance, rail_head - t.rail.head_height}));
    }
    parts.beam(s == 0 ? "LEFT" : "RIGHT", rail.node, t.rail.A, t.rail.Iy);
  }
  const auto support = [&parts](int a, int b, const SupportParameters& k) {
    parts.spring(a, b, 1, k.kx);
    parts.spring(a, b, 2, k.ky);
    parts.spring(a, b, 3, k.kz);
  };
  const int ground = parts.node({1, 2, 3});
  const double half = 0.5 * t.sleeper.height, bottom = rail_head - t.rail.height - t.sleeper.height;
  for (int i = first; i <= last; ++i) {
    const Body sleeper{parts.node({}), parts.node({})};
    const bool on_deck = i >= 0 && i < along;
    for (std::size_t s = 0; s < 2; ++s) {
      const double y = sides[s] * t.half_ballast_distance;
      support(rails[s].at(bay * i), parts.point(sleeper.at(0.0, sides[s] * t.half_rail_distance, half)), t.pad);
      support(parts.point(sleeper.at(0.0, y, -half)),
              on_deck ? ballast_on_deck(i, under(track + y), bottom, parts) : ground,
              on_deck ? t.ballast_deck : t.ballast_ground);
    }
  }
  return rails;
}

/// The coach up and down, in roll and in pitch: at rest no side force acts on its springs.
CoachOnShellDeck::Primary CoachOnShellDeck::stand_coach(const std::array<Rail, 2>& rails, double half_rail_distance,
                                                        double centre, Parts& parts, std::string& loads) const {
  const auto body = [&parts] { return Body{parts.node({1, 2}), parts.node({3})}; };
  const auto weigh = [&loads](int node, double mass) {
    loads += std::to_string(node) + ", 3, " + calculix::in_input(-mass * standard_gravity) + "\n";
  };
  const std::array<double, 4> places = wheelset_places();
  const Body car = body();
  weigh(car.centre, coach.car_body.mass);
  Primary primary;
  for (std::size_t b = 0; b < 2; ++b) {
    const Body bogie = body();
    weigh(bogie.centre, coach.bogie.mass);
    const double bogie_x = 0.5 * (places[2 * b] + places[2 * b + 1]);
    for (const double side : sides) {
      const double y = side * coach.secondary_half_distance;
      parts.spring(parts.point(bogie.vertically_at(0.0, y)), parts.point(car.vertically_at(bogie_x, y)), 3,
                   coach.secondary.kz);
    }
    parts.spring(bogie.rotation, car.rotation, 1, 2.0 * coach.secondary_bending + coach.roll_bar);
    parts.spring(bogie.rotation, car.rotation, 2, 2.0 * coach.secondary_bending);
    for (std::size_t w = 2 * b; w < 2 * b + 2; ++w) {
      const int left = rails[0].at(centre + places[w]), right = rails[1].at(centre + places[w]);
      weigh(left, 0.5 * coach.wheelset.mass);
      weigh(right, 0.5 * coach.wheelset.mass);
      auto& ends = primary.emplace_back();
      for (std::size_t s = 0; s < 2; ++s) {
        const double y = sides[s] * coach.primary_half_distance, share = 0.5 + 0.5 * y / half_rail_distance;
        ends[s] = {parts.point({Sum{}, Sum{}, Sum{{left, 3, share}, {right, 3, 1.0 - share}}}),
                   parts.point(bogie.vertically_at(places[w] - bogie_x, y))};
        parts.spring(ends[s].first, ends[s].second, 3, coach.primary.kz);
      }
    }
  }
  return primary;
}

CoachOnShellDeck::AtRest CoachOnShellDeck::calculix_at_rest(const TrackParameters& t, double centre) const {
  Parts parts;
  std::vector<double> wheel_x;
  for (const double place : wheelset_places()) wheel_x.push_back(centre + place);
  std::string loads, asked = "*NSET, NSET=ASKED\n";
  const std::array<Rail, 2> rails = lay_track(t, wheel_x, parts);
  const Primary primary = stand_coach(rails, t.half_rail_distance, centre, parts, loads);
  for (const double x : wheel_x) {
    for (const Rail& rail : rails) asked += std::to_string(rail.at(x)) + ",\n";
  }
  for (const auto& ends : primary) {
    for (const auto& [below, above] : ends) asked += std::to_string(below) + ",\n" + std::to_string(above) + ",\n";
  }
  calculate("coach", mesh() + parts.input(t.rail.E) + asked + "*STEP\n*STATIC\n*CLOAD\n" + loads +
                         "*NODE PRINT, NSET=EVERY\nU\n*NODE PRINT, NSET=ASKED\nU\n*END STEP\n");
  AtRest result;
  result.down = downward(printed("coach").back());
  for (const double x : wheel_x)
    result.rails.push_back({result.down.at(rails[0].at(x)), result.down.at(rails[1].at(x))});
  for (const auto& ends : primary) {
    std::array<double, 2> force{};
    for (std::size_t s = 0; s < 2; ++s) {
      force[s] = coach.primary.kz * (result.down.at(ends[s].second) - result.down.at(ends[s].first));
    }
    const double mean = 0.5 * (coach.wheelset.mass * standard_gravity + force[0] + force[1]);
    const double half_difference = 0.5 * coach.primary_half_distance / t.half_rail_distance * (force[0] - force[1]);
    result.wheels.push_back({mean + half_difference, mean - half_difference});
  }
  return result;
}

/// Of as many modes as calculix_in_motion() takes [1/s²].
std::vector<double> CoachOnShellDeck::eigenvalues(const std::string& name) const {
  std::vector<double> values;
  std::ifstream in(folder_ / (name + ".dat"));
  for (std::string row; values.size() < modes && std::getline(in, row);) {
    int mode = 0;
    double value = 0.0, omega = 0.0;
    if (std::sscanf(row.c_str(), "%d %lf %lf", &mode, &value, &omega) == 3) values.push_back(value);
  }
  return values;
}

/// Displacement of the deck's edges and of its nodes under the ballast [m], down, every so many steps: CalculiX's modes
/// over time, and what its statics has more than the same modes at rest.
std::vector<std::map<int, double>> CoachOnShellDeck::calculix_in_motion(const Crossing& crossing, double time_step,
                                                                        const TrackParameters& t) const {
  Parts parts;
  std::vector<PointLoad> loads;
  for (int i = 0; i < along; ++i) {
    for (std::size_t s = 0; s < 2; ++s) {
      const int j = under(track + sides[s] * t.half_ballast_distance);
      const int point = ballast_on_deck(i, j, rail_head - t.rail.height - t.sleeper.height, parts);
      PointLoad left{point, 2, {}}, up{point, 3, {}};
      for (const std::vector<BallastForces::Force>& forces : crossing.ballast) {
        const BallastForces::Force& force = forces[2 * static_cast<std::size_t>(i) + s];
        left.force.push_back(-force.aside);
        up.force.push_back(-force.down);
      }
      loads.push_back(std::move(left));
      loads.push_back(std::move(up));
    }
  }
  std::string sets = "*NSET, NSET=LOADED\n", amplitudes, over_time;
  for (const PointLoad& at : loads) {
    const std::string node = std::to_string(at.point), dof = std::to_string(at.dof), name = "F" + dof + "_" + node;
    sets += node + ",\n";
    amplitudes += "*AMPLITUDE, NAME=" + name + "\n";
    for (std::size_t step = 0; step < at.force.size(); ++step) {
      amplitudes += calculix::in_input(time_step * static_cast<double>(step)) + ", " +
                    calculix::in_input(at.force[step]) + (step % 4 == 3 ? "\n" : ", ");
    }
    if (amplitudes.back() != '\n') amplitudes += "\n";
    over_time += "*CLOAD, AMPLITUDE=" + name + "\n" + node + ", " + dof + ", 1.\n";
  }
  sets += "*NSET, NSET=WATCHED\n";
  for (int i = 0; i <= along; ++i) {
    for (const int j : {0, under(track - 0.75), under(track + 0.75), across}) {
      sets += std::to_string(number(i, j)) + ",\n";
    }
  }
  const std::string deck = mesh() + parts.input(t.rail.E) + sets;
  const double duration = time_step * static_cast<double>(crossing.ballast.size() - 1);
  calculate("moving", deck + amplitudes + "*STEP\n*FREQUENCY, STORAGE=YES\n" + std::to_string(modes) +
                          "\n*NODE PRINT, NSET=WATCHED\nU\n*NODE PRINT, NSET=LOADED\nU\n*END STEP\n" +
                          "*STEP, INC=100000\n*MODAL DYNAMIC\n" + calculix::in_input(time_step) + ", " +
                          calculix::in_input(duration) + "\n*MODAL DAMPING, RAYLEIGH\n,,0., " +
                          calculix::in_input(stiffness_damping) + "\n" + over_time +
                          "*NODE PRINT, NSET=WATCHED, FREQUENCY=" + std::to_string(every) + "\nU\n*END STEP\n");
  std::string still;
  for (std::size_t step = every; step < crossing.ballast.size(); step += every) {
    still += "*STEP\n*STATIC\n*CLOAD, OP=NEW\n";
    for (const PointLoad& at : loads) {
      still +=
          std::to_string(at.point) + ", " + std::to_string(at.dof) + ", " + calculix::in_input(at.force[step]) + "\n";
    }
    still += "*NODE PRINT, NSET=WATCHED\nU\n*END STEP\n";
  }
  calculate("still", deck + still);

  const std::vector<Printed> at_rest = printed("still"), shapes_and_motion = printed("moving");
  const std::vector<double> omega2 = eigenvalues("moving");
  std::vector<std::map<int, double>> history;
  for (std::size_t k = 0; k < at_rest.size(); ++k) {
    std::map<int, double>& down = history.emplace_back(downward(shapes_and_motion.at(modes + k)));
    for (auto& [n, value] : down) value -= at_rest[k].at(n)[2];
    for (std::size_t m = 0; m < modes; ++m) {
      const Printed& shape = shapes_and_motion[m];
      double work = 0.0;
      for (const PointLoad& at : loads) {
        work += shape.at(at.point)[static_cast<std::size_t>(at.dof) - 1] * at.force[(k + 1) * every];
      }
      for (auto& [n, value] : down) value += shape.at(n)[2] * work / omega2[m];
    }
  }
  return history;
}

double rail_deflection(const RailLine& rail, double x, const Eigen::VectorXd& displacement) {
  const RailInterpolation rows = rail_interpolation(rail, x);
  double down = 0.0;
  for (std::size_t k = 0; k < rows.dof.size(); ++k) {
    if (rows.dof[k] != held) down += rows.z[k] * displacement[rows.dof[k]];
  }
  return down;
}

// Six places of a slow crossing.
TEST_F(CoachOnShellDeck, AtRestIsThatOfCalculix) {
  if (!installed()) GTEST_SKIP() << missing;
  const TrackParameters rails = ballasted_track();
  VsiModel model = on_rails(imported(rails), 0.0, 1.0);
  DeckDifference all;
  Difference wheel, rail;
  for (const double centre : {-4.9, -0.4, 4.1, 9.3, 13.8, 18.3}) {
    model.vehicle_x = {centre};
    VsiState state(model);
    ASSERT_TRUE(static_equilibrium(model, state).converged);
    const Eigen::VectorXd found = model.structure->deck.rows * state.structure.whole().displacement;
    const AtRest expected = calculix_at_rest(rails, centre);
    DeckDifference here;
    add(*model.structure, found, expected.down, here);
    add(*model.structure, found, expected.down, all);
    // also where both bogies stand beside supports and the deck moves least
    for (const Difference* of : {&here.edge, &here.twist, &here.roll}) EXPECT_LT(of->percent(), 1.0) << centre;
    StepRecord record;
    fill_record(model, state, record);
    ASSERT_EQ(record.wheels.size(), 2 * expected.wheels.size());
    for (std::size_t w = 0; w < record.wheels.size(); ++w) {
      wheel.add(record.wheels[w].Q, expected.wheels[w / 2][w % 2]);
      rail.add(rail_deflection(model.structure->rail[w % 2], centre + wheelset_places()[w / 2],
                               state.structure.whole().displacement),
               expected.rails[w / 2][w % 2]);
    }
  }
  EXPECT_EQ(all.edges, 2 * (along + 1));
  EXPECT_GT(all.twists, 40);
  expect_as_calculix("calculix.coach", all);
  testing::measured("calculix.coach_wheel", wheel.percent());
  testing::measured("calculix.coach_rail", rail.percent());
  testing::measured("calculix.coach_rail_mm", 1e3 * rail.largest);
  EXPECT_LT(wheel.percent(), 0.1);
  EXPECT_LT(rail.percent(), 1.0) << "CalculiX's rails bend by shear too";
}

// The ballast is soft aside: what it exerts there between a sleeper's two halves, unknown, is then nothing.
TEST_F(CoachOnShellDeck, InMotionIsThatOfCalculix) {
  if (!installed()) GTEST_SKIP() << missing;
  constexpr double time_step = 5e-4, speed = 200.0 / 3.6, from = -7.0, to = 26.0;  // of the first wheelset [m]
  TrackParameters rails = ballasted_track();
  rails.ballast_deck.kx = rails.ballast_deck.ky = 1e6;
  rails.ballast_deck.cx = rails.ballast_deck.cy = 1e3;
  const VsiModel model = on_rails(imported(rails), from - wheelset_places().front(), speed);
  const BallastForces ballast(*model.structure, rails);
  Crossing crossing;
  RunObserver observer;
  observer.state = [&](const VsiState& state) {
    crossing.channels.emplace_back(model.structure->deck.rows * state.structure.whole().displacement);
    std::vector<BallastForces::Force>& forces = crossing.ballast.emplace_back();
    for (int i = 0; i < along; ++i) {
      for (const BallastForces::Force& force : ballast.under(i, state.structure.whole())) forces.push_back(force);
    }
  };
  VsiState state(model);
  ASSERT_TRUE(steady_start(model, state).converged);
  IntegrationParameters integration;
  integration.time_step = time_step;
  constexpr int record_nothing = 1000000;
  ASSERT_TRUE(simulate(model, integration, (to - from) / speed, record_nothing, state, observer).complete);

  const std::vector<std::map<int, double>> expected = calculix_in_motion(crossing, time_step, rails);
  ASSERT_EQ(expected.size(), (crossing.channels.size() - 1) / every);
  DeckDifference all;
  for (std::size_t k = 0; k < expected.size(); ++k) {
    add(*model.structure, crossing.channels[(k + 1) * every], expected[k], all);
  }
  expect_as_calculix("calculix.coach_moving", all);
  testing::measured("calculix.coach_moving_instants", static_cast<double>(expected.size()));
}

}  // namespace
}  // namespace railtab
