// Writes docs/validation/integrators.csv: wheel forces and deck accelerations by integrators of second to fourth order
// in time, against converged steps. integrator_study [FILE.csv]; docs/theory/time_integration.md quotes it.
//
// Two wheelsets under constant loads cross a span on a rough track, on linear springs of a Hertz contact's stiffness,
// so that every method solves its equations exactly. All have the same matrices; time alone differs.
#include <fmt/format.h>

#include <Eigen/Dense>
#include <Eigen/SparseLU>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/process_end.hpp"
#include "railtab/runtime/base/text_file.hpp"
#include "railtab/runtime/line/irregularity.hpp"
#include "railtab/runtime/line/irregularity_spectrum.hpp"
#include "railtab/runtime/structure/structure_model.hpp"
#include "railtab/runtime/structure/track_bridge.hpp"
#include "railtab/runtime/vsi/hht.hpp"
#include "railtab/runtime/vsi/rail_contact.hpp"

namespace railtab {
namespace {

using Sparse = Eigen::SparseMatrix<double>;
using Factor = Eigen::SparseLU<Sparse>;
using Eigen::MatrixXd, Eigen::VectorXd;

constexpr double speed = 200.0 / 3.6;
constexpr double load = 104e3, unsprung_mass = 1800.0, contact_stiffness = 2.4e9;  // of a wheelset, both rails
constexpr std::array<double, 2> wheelset_x{-2.0, -4.56};
constexpr int wheelsets = static_cast<int>(wheelset_x.size());
constexpr double duration = 0.84, judged_from = 0.1, reference_step = 5e-5;  // s
constexpr const char* header = "elements_per_bay,method,order,solutions,time_step_ms,force_percent,deck_percent\n";

/// Adds a matrix, times a factor, to the entries of a larger one, from a row and a column on.
void add_block(const Sparse& matrix, double factor, Eigen::Index row, Eigen::Index column,
               std::vector<Eigen::Triplet<double>>& entries) {
  for (int j = 0; j < matrix.outerSize(); ++j) {
    for (Sparse::InnerIterator e(matrix, j); e; ++e) {
      entries.emplace_back(row + e.row(), column + j, factor * e.value());
    }
  }
}

/// M a'' + C v + K a = g − B f, f = k_H (Bᵀ a − r): track and bridge, the wheelsets behind their unknowns. Bᵀ a is how
/// far a wheelset has come down further than its rails, r their deviation.
struct Scene {
  StructureModel structure;
  Irregularity irregularity;
  Sparse mass, damping, stiffness;
  Eigen::Index unknowns;
  VectorXd gravity;
  int deck = held;  ///< unknown whose acceleration is judged
  std::unique_ptr<const Factor> mass_factor;

  explicit Scene(int elements_per_bay) {
    TrackParameters track;
    track.length_before = track.length_after = 30.0;
    track.elements_per_bay = elements_per_bay;
    structure = build_track_bridge(track, {BridgeParameters{}}, MotionPlane::vertical);
    SpectrumParameters spectrum;
    spectrum.name = "german-low";
    spectrum.fade_in = 3.0;
    irregularity = random_irregularity(spectrum, -10.0, 60.0, wheelset_x[0]);
    unknowns = structure.dofs() + wheelsets;
    mass = with_wheelsets(structure.mass, unsprung_mass);
    damping = with_wheelsets(structure.damping, 0.0);
    stiffness = with_wheelsets(structure.stiffness, 0.0);
    gravity = VectorXd::Zero(unknowns);
    gravity.tail(wheelsets).setConstant(load);
    for (const StructureNode& node : structure.nodes) {
      if (node.name == "deck-midspan-1") deck = node.dof[2];
    }
    if (deck == held) throw ComputationError("no deck-midspan-1");
    mass_factor = std::make_unique<const Factor>(mass);
  }

  struct Contact {
    MatrixXd B;
    VectorXd r;
  };
  [[nodiscard]] Contact contact(double time) const {
    Contact c{MatrixXd::Zero(unknowns, wheelsets), VectorXd::Zero(wheelsets)};
    for (int w = 0; w < wheelsets; ++w) {
      const double x = wheelset_x[static_cast<std::size_t>(w)] + speed * time;
      for (const RailSide side : {RailSide::left, RailSide::right}) {
        const RailContact rail = rail_contact(structure, side, x);
        for (std::size_t k = 0; k < rail.rows.dof.size(); ++k) {
          if (rail.rows.dof[k] != held) c.B(rail.rows.dof[k], w) -= 0.5 * rail.rows.z[k];
        }
        c.r[w] += 0.5 * irregularity.at(side, x).z;
      }
      c.B(structure.dofs() + w, w) = 1.0;
    }
    return c;
  }

 private:
  [[nodiscard]] Sparse with_wheelsets(const Sparse& matrix, double of_wheelset) const {
    std::vector<Eigen::Triplet<double>> entries;
    add_block(matrix, 1.0, 0, 0, entries);
    for (int w = 0; w < wheelsets; ++w) entries.emplace_back(structure.dofs() + w, structure.dofs() + w, of_wheelset);
    Sparse result(unknowns, unknowns);
    result.setFromTriplets(entries.begin(), entries.end());
    return result;
  }
};

struct State {
  VectorXd a, v, f;
};

State at_rest(const Scene& s) {
  const Scene::Contact c = s.contact(0.0);
  const int dofs = s.structure.dofs();
  State state{VectorXd::Zero(s.unknowns), VectorXd::Zero(s.unknowns), VectorXd::Constant(wheelsets, load)};
  state.a.head(dofs) = Factor(s.structure.stiffness).solve(-(c.B.topRows(dofs) * state.f));
  state.a.tail(wheelsets) = state.f / contact_stiffness + c.r - c.B.topRows(dofs).transpose() * state.a.head(dofs);
  return state;
}

struct Response {
  VectorXd w, f;
};
/// K̄ w = R − L f with f = k_H (Bᵀ (a + G w) − r), of one stage or of several in one vector.
template <class Motion>
Response respond(const Factor& factor, const VectorXd& R, const MatrixXd& L, const MatrixXd& B, const VectorXd& a,
                 const VectorXd& r, const Motion& G) {
  const VectorXd free = factor.solve(R);
  const MatrixXd of_forces = factor.solve(L);
  const MatrixXd system = MatrixXd::Identity(B.cols(), B.cols()) / contact_stiffness + B.transpose() * G(of_forces);
  const VectorXd f = system.partialPivLu().solve(B.transpose() * (a + G(free)) - r);
  return {free - of_forces * f, f};
}

/// By the equation of motion.
double deck_acceleration(const Scene& s, const Scene::Contact& c, const State& y) {
  const VectorXd force = s.gravity - c.B * y.f - s.damping * y.v - s.stiffness * y.a;
  return s.mass_factor->solve(force)[s.deck];
}

/// Makes the step from a time on; returns the deck's acceleration at its end.
using Step = std::function<double(double time, State& state)>;

Step hht(const Scene& s, double alpha, double dt) {
  const HhtScheme scheme{.alpha = alpha, .time_step = dt};
  const auto factor = std::make_shared<const Factor>(
      s.mass * scheme.acceleration_rate() + scheme.load_weight() * (scheme.velocity_rate() * s.damping + s.stiffness));
  return [&s, scheme, factor, acceleration = VectorXd(VectorXd::Zero(s.unknowns))](double time, State& y) mutable {
    const double dt = scheme.time_step, alpha = scheme.alpha, weight = scheme.load_weight();
    const Scene::Contact begin = s.contact(time), end = s.contact(time + dt);
    const VectorXd a = y.a + dt * y.v + dt * dt * (0.5 - scheme.beta()) * acceleration;
    const VectorXd v = y.v + dt * (1.0 - scheme.gamma()) * acceleration;
    const VectorXd R = s.gravity + alpha * (begin.B * y.f) - s.damping * (weight * v - alpha * y.v) -
                       s.stiffness * (weight * a - alpha * y.a);
    const Response end_of_step =
        respond(*factor, R, weight * end.B, end.B, a, end.r, [](const MatrixXd& w) { return w; });
    y = {a + end_of_step.w, v + scheme.velocity_rate() * end_of_step.w, end_of_step.f};
    acceleration = scheme.acceleration_rate() * end_of_step.w;
    return deck_acceleration(s, end, y);
  };
}

/// Coefficients of a Runge–Kutta method [HairerWanner1996].
struct Tableau {
  MatrixXd A;
  VectorXd b, c;
};

/// The step's end from the accelerations w of its stages.
double finish(const Scene& s, const Tableau& t, double time, double dt, const std::vector<VectorXd>& w, State& y) {
  const VectorXd bA = t.A.transpose() * t.b;
  y.a += dt * y.v;
  for (std::size_t i = 0; i < w.size(); ++i) y.a += dt * dt * bA[static_cast<Eigen::Index>(i)] * w[i];
  for (std::size_t i = 0; i < w.size(); ++i) y.v += dt * t.b[static_cast<Eigen::Index>(i)] * w[i];
  const Scene::Contact end = s.contact(time + dt);
  y.f = contact_stiffness * (end.B.transpose() * y.a - end.r);
  return deck_acceleration(s, end, y);
}

/// Stages one after the other, with one factor.
Step diagonally_implicit(const Scene& s, const Tableau& t, double dt) {
  const double h = t.A(0, 0) * dt;
  const auto factor = std::make_shared<const Factor>(Sparse(s.mass + h * s.damping + h * h * s.stiffness));
  return [&s, t, dt, h, factor](double time, State& y) {
    std::vector<VectorXd> v, w;
    for (Eigen::Index i = 0; i < t.b.size(); ++i) {
      VectorXd a_i = y.a, v_i = y.v;
      for (Eigen::Index j = 0; j < i; ++j) {
        a_i += dt * t.A(i, j) * v[static_cast<std::size_t>(j)];
        v_i += dt * t.A(i, j) * w[static_cast<std::size_t>(j)];
      }
      a_i += h * v_i;
      const Scene::Contact c = s.contact(time + t.c[i] * dt);
      const Response stage = respond(*factor, s.gravity - s.damping * v_i - s.stiffness * a_i, c.B, c.B, a_i, c.r,
                                     [h](const MatrixXd& x) { return MatrixXd(h * h * x); });
      w.push_back(stage.w);
      v.push_back(v_i + h * stage.w);
    }
    return finish(s, t, time, dt, w, y);
  };
}

/// Two stages at once.
Step fully_implicit(const Scene& s, const Tableau& t, double dt) {
  const Eigen::Index n = s.unknowns;
  const MatrixXd A2 = t.A * t.A;
  std::vector<Eigen::Triplet<double>> entries;
  for (Eigen::Index i = 0; i < 2; ++i) {
    add_block(s.mass, 1.0, i * n, i * n, entries);
    for (Eigen::Index j = 0; j < 2; ++j) {
      add_block(s.damping, dt * t.A(i, j), i * n, j * n, entries);
      add_block(s.stiffness, dt * dt * A2(i, j), i * n, j * n, entries);
    }
  }
  Sparse both(2 * n, 2 * n);
  both.setFromTriplets(entries.begin(), entries.end());
  const auto factor = std::make_shared<const Factor>(both);
  return [&s, t, dt, n, A2, factor](double time, State& y) {
    VectorXd R(2 * n), a(2 * n), r(2 * wheelsets);
    MatrixXd B = MatrixXd::Zero(2 * n, 2 * wheelsets);
    for (Eigen::Index i = 0; i < 2; ++i) {
      const Scene::Contact c = s.contact(time + t.c[i] * dt);
      B.block(i * n, i * wheelsets, n, wheelsets) = c.B;
      r.segment(i * wheelsets, wheelsets) = c.r;
      a.segment(i * n, n) = y.a + t.c[i] * dt * y.v;
      R.segment(i * n, n) = s.gravity - s.damping * y.v - s.stiffness * a.segment(i * n, n);
    }
    const Response stages = respond(*factor, R, B, B, a, r, [&](const MatrixXd& w) {
      MatrixXd moved(w.rows(), w.cols());
      for (Eigen::Index i = 0; i < 2; ++i) {
        moved.middleRows(i * n, n) = dt * dt * (A2(i, 0) * w.topRows(n) + A2(i, 1) * w.bottomRows(n));
      }
      return moved;
    });
    return finish(s, t, time, dt, {stages.w.head(n), stages.w.tail(n)}, y);
  };
}

Tableau tableau(const MatrixXd& A, const VectorXd& b) { return {A, b, A.rowwise().sum()}; }

/// A-stable, third order, two stages; leaves 0.73 of the highest frequencies' motion after a step [HairerWanner1996,
/// Table 6.3].
Tableau two_stages_of_third_order() {
  const double g = (3.0 + std::sqrt(3.0)) / 6.0;
  MatrixXd A(2, 2);
  A << g, 0.0, 1.0 - 2.0 * g, g;
  return tableau(A, VectorXd::Constant(2, 0.5));
}

/// L-stable, third order, three stages [Alexander1977].
Tableau three_stages_of_third_order() {
  const double g = 0.43586652150845899942;
  const double b1 = -(6.0 * g * g - 16.0 * g + 1.0) / 4.0, b2 = (6.0 * g * g - 20.0 * g + 5.0) / 4.0;
  MatrixXd A(3, 3);
  A << g, 0.0, 0.0, 0.5 * (1.0 - g), g, 0.0, b1, b2, g;
  return tableau(A, A.row(2).transpose());
}

/// Fourth order, without damping: Gauss's two points.
Tableau two_points_of_gauss() {
  const double s = std::sqrt(3.0) / 6.0;
  MatrixXd A(2, 2);
  A << 0.25, 0.25 - s, 0.25 + s, 0.25;
  return tableau(A, VectorXd::Constant(2, 0.5));
}

/// Force of the first wheelset and acceleration of the deck at the ends of steps.
struct History {
  std::vector<double> force, deck;
};

History history(const Scene& s, const Step& step, double dt) {
  State state = at_rest(s);
  History result;
  const auto steps = static_cast<int>(std::lround(duration / dt));
  for (int k = 0; k < steps; ++k) {
    result.deck.push_back(step(k * dt, state));
    result.force.push_back(state.f[0]);
  }
  return result;
}

/// rms of the difference over rms of the dynamic part [%].
double error(const std::vector<double>& values, const std::vector<double>& reference, double dt) {
  const auto every = static_cast<std::size_t>(std::lround(dt / reference_step));
  double square = 0.0, sum = 0.0, sum_of_squares = 0.0;
  int count = 0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (static_cast<double>(k + 1) * dt < judged_from) continue;
    const double exact = reference[(k + 1) * every - 1];
    square += (values[k] - exact) * (values[k] - exact);
    sum += exact;
    sum_of_squares += exact * exact;
    ++count;
  }
  return 100.0 * std::sqrt(square / (sum_of_squares - sum * sum / count));
}

std::string rows(int elements_per_bay, const std::vector<double>& steps_ms) {
  const Scene s(elements_per_bay);
  struct Method {
    const char* name;
    int order;      ///< of smooth motions that a step resolves
    int solutions;  ///< of real systems a step; a complex one counts as four
    std::function<Step(double)> of;
  };
  const std::vector<Method> methods{
      {"HHT", 2, 1, [&](double dt) { return hht(s, -0.05, dt); }},
      {"two diagonal stages", 3, 2, [&](double dt) { return diagonally_implicit(s, two_stages_of_third_order(), dt); }},
      {"three diagonal stages", 3, 3,
       [&](double dt) { return diagonally_implicit(s, three_stages_of_third_order(), dt); }},
      {"two points of Gauss", 4, 4, [&](double dt) { return fully_implicit(s, two_points_of_gauss(), dt); }}};
  const History reference =
      history(s, diagonally_implicit(s, three_stages_of_third_order(), reference_step), reference_step);
  std::string text;
  for (const Method& method : methods) {
    for (const double ms : steps_ms) {
      const double dt = 1e-3 * ms;
      const History found = history(s, method.of(dt), dt);
      text +=
          fmt::format("{},{},{},{},{:g},{:.3g},{:.3g}\n", elements_per_bay, method.name, method.order, method.solutions,
                      ms, error(found.force, reference.force, dt), error(found.deck, reference.deck, dt));
    }
  }
  return text;
}

int write_study(const std::string& file) {
  // in the reference's own steps: by how much converged methods differ
  const std::string text = header + rows(4, {0.05, 0.25, 0.5, 1.0, 1.5, 2.0, 3.0}) + rows(16, {0.5, 1.0, 1.5, 2.0});
  print_text(text);
  write_text_file(file, text, header);
  return 0;
}

}  // namespace
}  // namespace railtab

int main(int argc, char** argv) {
  return railtab::run_process("integrator_study",
                              [&] { return railtab::write_study(argc > 1 ? argv[1] : "integrators.csv"); });
}
