// Axle loads on decks by modes, against closed forms that share no code with them.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "../measured.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/moving_load/speed_range.hpp"
#include "railtab/runtime/moving_load/speed_search.hpp"

namespace railtab {
namespace {

constexpr double pi = std::numbers::pi;

/// L = 25 m, m = 15 t/m, EI = 30 GN m², ζ = 1 %.
BridgeParameters span() {
  BridgeParameters p;
  p.length = 25.0;
  p.mass = 15e3;
  p.E = 30e9;
  p.Iy = 1.0;
  p.damping_ratio = 0.01;
  return p;
}

struct Peaks {
  double acceleration, displacement, end_rotation;
};

/// Largest |f| of samples in even steps, by the parabola through the largest and its neighbours.
double peak_of(const std::vector<double>& f) {
  double peak = 0.0;
  for (std::size_t i = 1; i + 1 < f.size(); ++i) {
    const double a = f[i - 1], b = f[i], c = f[i + 1];
    if (std::abs(b) < std::abs(a) || std::abs(b) < std::abs(c)) continue;
    const double bend = a - 2.0 * b + c;
    peak = std::max(peak, std::abs(bend == 0.0 ? b : b - (c - a) * (c - a) / (8.0 * bend)));
  }
  return peak;
}

/// Superposition of the sine modes of a simply supported beam and of single axles: while an axle is on the beam
///   q = A sin Ωt + B cos Ωt + e^{−ζωt} (C cos ω_d t + D sin ω_d t), Ω = nπv/L,
/// at rest at t = 0, and free from t = L/v on. Accelerations of `of_acceleration` modes, displacements of
/// `of_displacement`, in steps of 1/64 of the period of the last mode of the accelerations, at 200 places.
Peaks superposition(const BridgeParameters& p, const AxleTrain& train, double v, int of_acceleration,
                    int of_displacement) {
  const double L = p.length, M = 0.5 * p.mass * L, zeta = p.damping_ratio,
               first = pi * pi / (L * L) * std::sqrt(p.E / p.mass);
  const double dt = 2.0 * pi / (first * of_acceleration * of_acceleration) / 64.0;
  const double begin = train.behind.front() / v, end = (train.behind.back() + L) / v + 2.0 * 2.0 * pi / first;
  const auto steps = static_cast<std::size_t>((end - begin) / dt);
  std::vector<std::vector<double>> q(static_cast<std::size_t>(of_displacement), std::vector<double>(steps)), a = q;
  for (int n = 1; n <= of_displacement; ++n) {
    const double w = first * n * n, wd = w * std::sqrt(1.0 - zeta * zeta), O = n * pi * v / L, T = L / v;
    const double d = (w * w - O * O) * (w * w - O * O) + std::pow(2.0 * zeta * w * O, 2);
    const double A = (w * w - O * O) / d / M, B = -2.0 * zeta * w * O / d / M, C = -B, D = (zeta * w * C - A * O) / wd;
    const auto decay = [&](double t, double c, double s, double& x, double& dx) {
      const double e = std::exp(-zeta * w * t), cosine = std::cos(wd * t), sine = std::sin(wd * t);
      x += e * (c * cosine + s * sine);
      dx += e * ((wd * s - zeta * w * c) * cosine - (wd * c + zeta * w * s) * sine);
    };
    double xT = A * std::sin(O * T) + B * std::cos(O * T), dxT = O * (A * std::cos(O * T) - B * std::sin(O * T));
    decay(T, C, D, xT, dxT);
    for (std::size_t k = 0; k < train.behind.size(); ++k) {
      const double P = train.load[k], enters = train.behind[k] / v;
      for (std::size_t i = static_cast<std::size_t>(std::max(0.0, (enters - begin) / dt)); i < steps; ++i) {
        const double t = begin + dt * static_cast<double>(i) - enters;
        if (t < 0.0) continue;
        double x = 0.0, dx = 0.0, force = 0.0;
        if (t <= T) {
          x = A * std::sin(O * t) + B * std::cos(O * t);
          dx = O * (A * std::cos(O * t) - B * std::sin(O * t));
          force = std::sin(O * t) / M;
          decay(t, C, D, x, dx);
        } else {
          decay(t - T, xT, (dxT + zeta * w * xT) / wd, x, dx);
        }
        q[static_cast<std::size_t>(n - 1)][i] += P * x;
        a[static_cast<std::size_t>(n - 1)][i] += P * (force - 2.0 * zeta * w * dx - w * w * x);
      }
    }
  }
  Peaks peaks{0.0, 0.0, 0.0};
  constexpr int places = 200;
  std::vector<double> sum(steps);
  for (int j = 1; j < places; ++j) {
    const auto at = [&](const std::vector<std::vector<double>>& f, int modes) {
      std::fill(sum.begin(), sum.end(), 0.0);
      for (int n = 1; n <= modes; ++n) {
        const double shape = std::sin(n * pi * j / places);
        for (std::size_t i = 0; i < steps; ++i) sum[i] += shape * f[static_cast<std::size_t>(n - 1)][i];
      }
      return peak_of(sum);
    };
    peaks.acceleration = std::max(peaks.acceleration, at(a, of_acceleration));
    peaks.displacement = std::max(peaks.displacement, at(q, of_displacement));
  }
  for (const int last : {1, -1}) {  // slopes nπ/L at x = 0, (−1)^n nπ/L at x = L
    std::fill(sum.begin(), sum.end(), 0.0);
    for (int n = 1; n <= of_displacement; ++n) {
      const double slope = n * pi / L * (n % 2 == 0 ? 1.0 : last);
      for (std::size_t i = 0; i < steps; ++i) sum[i] += slope * q[static_cast<std::size_t>(n - 1)][i];
    }
    peaks.end_rotation = std::max(peaks.end_rotation, peak_of(sum));
  }
  return peaks;
}

TEST(TrainPassage, FrequenciesOfASimplySupportedSpan) {
  const ModalDeck deck = simply_supported_deck(span());
  ASSERT_EQ(deck.dynamic_modes, 3) << "up to the third frequency, the greatest of 30 Hz, 1.5 f1 and f3";
  EXPECT_NEAR(deck.frequency(0), 3.554306, 1e-6);
  EXPECT_NEAR(deck.frequency(1), 14.217225, 1e-6);
  EXPECT_NEAR(deck.frequency(2), 31.988757, 1e-6);
}

TEST(TrainPassage, ShapesAreSinesOfModalMassOne) {
  const ModalDeck deck = simply_supported_deck(span());
  for (int n = 1; n <= 3; ++n) {
    const double amplitude = std::sqrt(2.0 / (15e3 * 25.0));
    for (const double x : {0.0, 0.37, 3.1, 12.5, 17.77, 25.0}) {
      const double k = n * pi / 25.0;
      EXPECT_NEAR(deck.shape_at(x)[n - 1], amplitude * std::sin(k * x), 4e-6 * amplitude);
      EXPECT_NEAR(deck.shape_at(x, 1)[n - 1], amplitude * k * std::cos(k * x), 2e-4 * amplitude * k);
    }
  }
}

/// Beside the axis at e the span twists too: at rest a load in the middle deflects the track there by
/// PL³/(48 EI) + P e² L/(4 GJ).
TEST(TrainPassage, ATrackBesideTheAxisTwistsTheSpan) {
  BridgeParameters p = span();
  p.track_offset = -2.3;
  p.G = 14.4e9;
  p.J = 0.5;
  p.rotary_inertia = 150e3;
  const ModalDeck deck = simply_supported_deck(p), central = simply_supported_deck(span());
  EXPECT_NEAR(deck.first_frequency(), central.first_frequency(), 1e-12);
  EXPECT_NEAR(deck.cut_off(), central.cut_off(), 1e-9);
  const double twist = std::sqrt(p.G * p.J / p.rotary_inertia) / (2.0 * p.length);
  EXPECT_NEAR(deck.frequency(1), twist, 1e-9 * twist) << "between the first and the second bending mode";
  EXPECT_NEAR(deck.frequency(2), 2.0 * twist, 1e-9 * twist);
  AxleTrain axle;
  axle.behind = {0.0};
  axle.load = {200e3};
  const double L = p.length, bending = 200e3 * L * L * L / (48.0 * p.E * p.Iy),
               torsion = 200e3 * 2.3 * 2.3 * L / (4.0 * p.G * p.J);
  EXPECT_NEAR(largest_static_deflection(deck, axle).value, bending + torsion, 0.01 * torsion);
  EXPECT_GT(torsion, 0.2 * bending);
}

TEST(TrainPassage, SixReferenceWagonsAtRest) {
  const StaticDeflection found =
      largest_static_deflection(simply_supported_deck(span()), find_axle_train("en15528-d2*6", 25.0));
  EXPECT_NEAR(found.value, 11.2539e-3, 1e-3 * 11.2539e-3) << "published, g = 9.81 m/s²";
  // PL³/48EI of one axle in the middle, by all modes that the deck has
  AxleTrain axle;
  axle.behind = {0.0};
  axle.load = {100e3};
  const StaticDeflection one = largest_static_deflection(simply_supported_deck(span()), axle);
  EXPECT_NEAR(one.value, 100e3 * 25.0 * 25.0 * 25.0 / (48.0 * 30e9), 1e-5 * one.value);
  EXPECT_NEAR(one.x, 12.5, 1e-3);
  EXPECT_NEAR(one.front, 12.5, 1e-3);
}

/// Uniform load on the whole span, 5qL⁴/384EI, and of SW/0's 133 kN/m the same on 15 m in the middle of a longer span.
TEST(TrainPassage, StaticLoadModels) {
  BridgeParameters p = span();
  p.length = 10.0;
  const double sw2 = largest_static_deflection(simply_supported_deck(p), find_axle_train("sw/2", p.length)).value;
  EXPECT_NEAR(sw2, 5.0 * 150e3 * 1e4 / (384.0 * 30e9), 1e-4 * sw2) << "25 m of load cover the span";
  // LM71 by the influence line of the middle, η = x(3L² − 4x²)/48EI, x <= L/2
  const double L = p.length;
  const auto eta = [L](double x) {
    x = std::min(x, L - x);
    return x * (3.0 * L * L - 4.0 * x * x) / (48.0 * 30e9);
  };
  double lm71 = 0.0;
  for (const double x : {-2.4, -0.8, 0.8, 2.4}) lm71 += 250e3 * eta(0.5 * L + x);
  constexpr int pieces = 2000;
  for (int i = 0; i < pieces; ++i) {
    const double reach = 0.5 * L - 3.2, x = (i + 0.5) * reach / pieces;
    lm71 += 2.0 * 80e3 * eta(x) * reach / pieces;
  }
  const double found = largest_static_deflection(simply_supported_deck(p), find_axle_train("lm71", L)).value;
  EXPECT_NEAR(found, lm71, 1e-3 * lm71);
  EXPECT_GE(found, (1.0 - 1e-4) * lm71) << "the largest over all places of the model";
}

/// All ten trains of the high-speed load model at the resonance of their coaches, f1 times their length, and others.
TEST(TrainPassage, PeaksAreThoseOfAnOwnSuperposition) {
  const BridgeParameters p = span();
  const ModalDeck deck = simply_supported_deck(p);
  struct Case {
    std::string train;
    double speed;
    double sleepers;
  };
  std::vector<Case> cases{{"en15528-d2*6", 49.75, 0.0}, {"hslm-a3", 47.3, 0.6}, {"hslm-a8", 88.7, 0.0}};
  for (int number = 1; number <= 10; ++number) {
    const double coach = 17.0 + number;  // m
    cases.push_back({"hslm-a" + std::to_string(number), coach * deck.frequency(0), 0.0});
  }
  double worst = 0.0;
  for (const auto& [name, speed, sleepers] : cases) {
    AxleTrain train = find_axle_train(name, p.length);
    if (sleepers > 0.0) train = spread_over_sleepers(train, sleepers);
    const PassagePeaks found = train_passage(deck, modal_force(deck, train), speed);
    constexpr int all = 9;  // vibrate in the superposition, of which six add without inertia in what is tested
    const Peaks own = superposition(p, train, speed, 3, all);
    EXPECT_NEAR(found.acceleration.value, own.acceleration, 1e-3 * own.acceleration) << name;
    EXPECT_NEAR(found.displacement.value, own.displacement, 1e-3 * own.displacement) << name;
    // slopes of modes beyond the ninth: Σ 1/n³ beyond it, 0.6 % of that of the first for a single axle
    EXPECT_NEAR(found.end_rotation.value, own.end_rotation, 5e-3 * own.end_rotation) << name;
    worst = std::max({worst, std::abs(found.acceleration.value / own.acceleration - 1.0),
                      std::abs(found.displacement.value / own.displacement - 1.0)});
  }
  testing::measured("moving_load.peak_error", worst);
}

/// One force on an undamped span that has gone leaves mode 1 with the amplitude of the closed form
/// 2P/(M(ω² − Ω²)) (Ω/ω) cos(ωL/2v); the largest acceleration with one mode is then known too.
// Axles leave and come on at once but for the digits of a length in a file.
TEST(TrainPassage, RoundedLengthsChangeNothing) {
  BridgeParameters rounded = span();
  rounded.length += 8e-10;
  AxleTrain train;
  train.behind = {0.0, 2.5, 25.0, 27.5};
  train.load.assign(4, 170e3);
  const auto peaks = [&](const BridgeParameters& p) {
    const ModalDeck deck = simply_supported_deck(p);
    return train_passage(deck, modal_force(deck, train), 60.0);
  };
  const PassagePeaks whole = peaks(span()), nearly = peaks(rounded);
  EXPECT_NEAR(nearly.displacement.value, whole.displacement.value, 1e-5 * whole.displacement.value);
  EXPECT_NEAR(nearly.acceleration.value, whole.acceleration.value, 1e-5 * whole.acceleration.value);
}

TEST(TrainPassage, AnUndampedSpanKeepsItsVibration) {
  BridgeParameters p = span();
  p.damping_ratio = 0.0;
  const ModalDeck deck = simply_supported_deck(p, {1});
  ASSERT_EQ(deck.dynamic_modes, 1);
  AxleTrain axle;
  axle.behind = {0.0};
  axle.load = {100e3};
  const double v = 60.0, w = deck.omega[0], O = pi * v / p.length, M = 0.5 * p.mass * p.length;
  const double left = 2.0 * 100e3 / (M * (w * w - O * O)) * O / w * std::abs(std::cos(0.5 * w * p.length / v));
  const PassagePeaks found = train_passage(deck, modal_force(deck, axle), v);
  const double acceleration = w * w * left;
  EXPECT_GE(found.acceleration.value, (1.0 - 1e-5) * acceleration);
  const Peaks own = superposition(p, axle, v, 1, 1);
  EXPECT_NEAR(found.acceleration.value, own.acceleration, 1e-3 * own.acceleration);
}

/// A slow axle on a span turns its ends by at most P L²/(9 √3 EI), when it stands at 0.423 L from one of them.
TEST(TrainPassage, ASlowAxleTurnsTheEndsAsOneAtRest) {
  const BridgeParameters p = span();
  const ModalDeck deck = simply_supported_deck(p);
  AxleTrain axle;
  axle.behind = {0.0};
  axle.load = {100e3};
  const PassagePeaks found = train_passage(deck, modal_force(deck, axle), 0.5);
  const double standing = 100e3 * p.length * p.length / (9.0 * std::sqrt(3.0) * p.E * p.Iy);
  EXPECT_NEAR(found.end_rotation.value, standing, 4e-3 * standing);
  const double place = found.end_rotation.time * 0.5 / p.length, from_end = std::min(place, 1.0 - place);
  EXPECT_NEAR(from_end, 1.0 - std::sqrt(1.0 / 3.0), 0.02);
}

/// With one mode that vibrates the largest deflection is elsewhere and at another time than that of this mode. A train
/// that crosses slowly deflects the deck and turns its ends as much as one that stands at the worst place.
TEST(TrainPassage, PeaksAreThoseOfAllModesTogether) {
  const ModalDeck deck = simply_supported_deck(span(), {1});
  ASSERT_EQ(deck.dynamic_modes, 1);
  AxleTrain train;
  train.behind = {0.0, 4.0, 14.0};
  train.load = {250e3, 250e3, 150e3};
  const PassagePeaks found = train_passage(deck, modal_force(deck, train), 0.3);
  const StaticDeflection standing = largest_static_deflection(deck, train);
  EXPECT_GE(found.displacement.value, (1.0 - 1e-4) * standing.value);
  EXPECT_NEAR(found.displacement.value, standing.value, 2e-3 * standing.value);
  EXPECT_NEAR(found.displacement.x, standing.x, 0.15) << "of the mode that vibrates it is 12.5 m";
  EXPECT_GT(found.displacement.x, 12.6);
  double turn = 0.0;
  const Eigen::ArrayXd begin = deck.shape_at(0.0, 1), end = deck.shape_at(deck.length(), 1);
  for (int i = 0; i <= 1000; ++i) {
    const double s = (train.behind.back() + deck.length()) * i / 1000.0;
    const Eigen::ArrayXd q = modal_force_at(deck, train, s) / deck.omega.square();
    turn = std::max({turn, std::abs((q * begin).sum()), std::abs((q * end).sum())});
  }
  EXPECT_GE(found.end_rotation.value, (1.0 - 1e-3) * turn);
  EXPECT_NEAR(found.end_rotation.value, turn, 5e-3 * turn);
}

/// A rigid deck on a spring, with free ends: a force that comes on to it accelerates it at once by P/M. It leaves after
/// two periods, when it stops the motion.
TEST(TrainPassage, AForceComesOnToAFreeEnd) {
  constexpr double M = 1e5, length = 10.0, frequency = 2.0;
  ModalDeck deck;
  deck.knots = {0.0, length};
  deck.shape.push_back(ModalDeck::Cubics::Zero(1, 4));
  deck.shape[0](0, 0) = 1.0 / std::sqrt(M);
  deck.omega = Eigen::ArrayXd::Constant(1, 2.0 * pi * frequency);
  deck.damping = Eigen::ArrayXd::Zero(1);
  deck.dynamic_modes = 1;
  deck.point_x = {0.0, length};
  deck.point_shape = Eigen::MatrixXd::Constant(2, 1, 1.0 / std::sqrt(M));
  deck.points_on_line = 2;
  deck.largest_shape = Eigen::ArrayXd::Constant(1, 1.0 / std::sqrt(M));
  EXPECT_TRUE(has_free_end(deck));
  EXPECT_FALSE(has_free_end(simply_supported_deck(span())));
  EXPECT_NEAR(sudden_acceleration(deck, 3.0), 1.0 / M, 1e-12 / M) << "the whole deck heaves";
  EXPECT_LT(sudden_acceleration(simply_supported_deck(span()), 3.0), 1e-6 / M);
  AxleTrain axle;
  axle.behind = {0.0};
  axle.load = {100e3};
  const PassagePeaks found = train_passage(deck, modal_force(deck, axle), length * frequency / 2.0);
  EXPECT_NEAR(found.acceleration.value, 1.0, 1e-9);
  const double at_rest = 100e3 / (M * std::pow(2.0 * pi * frequency, 2));
  EXPECT_NEAR(found.displacement.value, 2.0 * at_rest, 1e-9 * at_rest);
}

TEST(TrainPassage, PiecesOfTheModalForceAreTheSumOverTheAxles) {
  const ModalDeck deck = simply_supported_deck(span());
  const AxleTrain train = find_axle_train("hslm-a2", 25.0);
  const ModalForce force = modal_force(deck, train);
  const double scale = 200e3 * deck.largest_shape[0];  // five axles at most, each within 4e-6
  for (std::size_t p = 0; p < force.pieces(); p += 7) {
    const double length = force.start[p + 1] - force.start[p], s = 0.3 * length;
    const Eigen::ArrayXd direct = modal_force_at(deck, train, force.start[p] + s);
    for (int n = 0; n < force.modes; ++n) {
      const ModalForce::Cubic& c = force.cubic[p * static_cast<std::size_t>(force.modes) + static_cast<std::size_t>(n)];
      EXPECT_NEAR(c[0] + s * (c[1] + s * (c[2] + s * c[3])), direct[n], 2e-5 * scale);
    }
  }
}

/// In the middle of the span 25/50/25 % on sleepers at distance a give PL³/48EI (1 + η(L/2 − a)/η(L/2))/2, and the
/// force on mode n is that of the axle times (1 + cos(nπa/L))/2.
TEST(TrainPassage, SpreadingBySleepers) {
  const double L = 25.0, a = 0.6, x = 0.5 * L - a;
  AxleTrain axle;
  axle.behind = {0.0};
  axle.load = {100e3};
  const AxleTrain spread = spread_over_sleepers(axle, a);
  EXPECT_EQ(spread.behind, (std::vector<double>{-a, 0.0, a}));
  EXPECT_EQ(spread.load, (std::vector<double>{25e3, 50e3, 25e3}));
  const ModalDeck deck = simply_supported_deck(span());
  const double whole = 100e3 * L * L * L / (48.0 * 30e9);
  const double beside = x * (3.0 * L * L - 4.0 * x * x) / (L * L * L);
  EXPECT_NEAR(largest_static_deflection(deck, spread).value, 0.5 * whole * (1.0 + beside), 1e-5 * whole);
  const Eigen::ArrayXd three = modal_force_at(deck, spread, 8.0), one = modal_force_at(deck, axle, 8.0);
  for (int n = 1; n <= 3; ++n) {
    EXPECT_NEAR(three[n - 1], one[n - 1] * 0.5 * (1.0 + std::cos(n * pi * a / L)),
                1e-5 * 100e3 * deck.largest_shape[0]);
  }
  const AxleTrain train = find_axle_train("hslm-a4", L);
  EXPECT_NEAR(spread_over_sleepers(train, a).total_load(), train.total_load(), 1e-9 * train.total_load());
}

/// All ten trains over 40 to 90 m/s: 25 passages of each find what 101 and what 1001 speeds of the governing train
/// show.
TEST(TrainPassage, CriticalSpeedsWithAQuarterOfTheGrid) {
  const ModalDeck deck = simply_supported_deck(span());
  std::vector<AxleTrain> trains;
  for (const std::string& name : expanded_names({"hslm-a"})) trains.push_back(find_axle_train(name, 25.0));
  ASSERT_EQ(trains.size(), 10U);
  SpeedRange grid{40.0, 90.0, {}};
  for (int i = 0; i <= 100; ++i) grid.speeds.push_back(40.0 + 0.5 * i);
  const std::vector<TrainResponse> all = train_responses(deck, trains, grid, 2);
  const std::vector<TrainResponse> sought = train_responses(deck, trains, {40.0, 90.0, {}}, 2);
  const auto governing = [](const std::vector<TrainResponse>& of, DeckPeak PassagePeaks::*quantity) {
    std::pair<double, std::size_t> most{0.0, 0};
    for (const TrainResponse& response : of) {
      for (const PassagePeaks& passage : response.passages) {
        most = std::max(most, {(passage.*quantity).value, response.train});
      }
    }
    return most;
  };
  std::size_t passages = 0;
  for (const TrainResponse& response : sought) passages += response.passages.size();
  EXPECT_LE(4 * passages, 10U * 101U);
  for (DeckPeak PassagePeaks::*quantity : {&PassagePeaks::acceleration, &PassagePeaks::displacement}) {
    const auto [value, train] = governing(sought, quantity);
    EXPECT_EQ(train, governing(all, quantity).second);
    EXPECT_GE(value, (1.0 - 1e-3) * governing(all, quantity).first);
  }
  // a grid ten times as fine about the largest acceleration
  const auto [value, train] = governing(sought, &PassagePeaks::acceleration);
  const double critical = sought[train].critical_acceleration().speed;
  const ModalForce force = modal_force(deck, trains[train]);
  for (double v = critical - 1.0; v <= critical + 1.0; v += 0.05) {
    EXPECT_LE(train_passage(deck, force, v).acceleration.value, (1.0 + 1e-3) * value) << v;
  }
}

/// Short and long, stiff and slack spans, each with the trains' own resonances: against 401 speeds.
TEST(TrainPassage, CriticalSpeedsOfOtherSpans) {
  struct Case {
    double length, frequency, damping;
    const char* train;
  };
  for (const auto& [length, frequency, damping, name] :
       {Case{10.0, 9.4, 0.005, "hslm-a8"}, Case{15.0, 9.6, 0.025, "hslm-a9"}, Case{50.0, 3.6, 0.01, "hslm-a9"}}) {
    BridgeParameters p = span();
    p.length = length;
    p.damping_ratio = damping;
    p.E = std::pow(2.0 * frequency * length * length / pi, 2) * p.mass;
    const ModalDeck deck = simply_supported_deck(p);
    const AxleTrain train = find_axle_train(name, length);
    const ModalForce force = modal_force(deck, train);
    double grid = 0.0, sought = 0.0;
    for (int i = 0; i <= 400; ++i) {
      grid = std::max(grid, train_passage(deck, force, 40.0 + 0.1 * i).acceleration.value);
    }
    const std::vector<PassagePeaks> found = search_critical_speeds(deck, train, 40.0, 80.0);
    for (const PassagePeaks& passage : found) sought = std::max(sought, passage.acceleration.value);
    EXPECT_LE(found.size(), 25U);
    EXPECT_GE(sought, (1.0 - 1e-3) * grid) << length << " m, " << name;
  }
}

TEST(TrainPassage, AnyNumberOfThreadsGivesTheSameNumbers) {
  const ModalDeck deck = simply_supported_deck(span());
  const std::vector<AxleTrain> trains{find_axle_train("hslm-a2", 25.0), find_axle_train("en15528-d4*5", 25.0),
                                      find_axle_train("lm71", 25.0)};
  const auto one = train_responses(deck, trains, {50.0, 60.0, {}}, 1);
  const auto three = train_responses(deck, trains, {50.0, 60.0, {}}, 3);
  for (std::size_t t = 0; t < trains.size(); ++t) {
    ASSERT_EQ(one[t].passages.size(), three[t].passages.size());
    EXPECT_EQ(one[t].passages.empty(), trains[t].only_static);
    for (std::size_t i = 0; i < one[t].passages.size(); ++i) {
      EXPECT_EQ(one[t].passages[i].speed, three[t].passages[i].speed);
      EXPECT_EQ(one[t].passages[i].acceleration.value, three[t].passages[i].acceleration.value);
    }
  }
}

}  // namespace
}  // namespace railtab
