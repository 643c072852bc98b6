#include "railtab/runtime/vsi/moving_window.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <iterator>

#include "railtab/runtime/algebra/sparse_ldlt.hpp"
#include "railtab/runtime/structure/lowest_modes.hpp"
#include "railtab/runtime/vsi/support_motion.hpp"
#include "railtab/runtime/vsi/vsi_model.hpp"

namespace railtab {

namespace {

using Sparse = Eigen::SparseMatrix<double>;

constexpr int span_modes = 16;  // of a span with its track: those of the deck that matter after a train
// The window moves on by this share of its length at a time, no less than the least stride.
constexpr double share_of_window = 0.125, least_stride = 10.0;  // [-], m
constexpr int together = 8;  // dofs, of which a span's motion is computed side by side

// Unknowns with from < x < to.
DofRange dofs_within(const std::vector<double>& x, double from, double to) {
  const auto begin = std::upper_bound(x.begin(), x.end(), from) - x.begin();
  return {begin, std::lower_bound(x.begin(), x.end(), to) - x.begin() - begin};
}

Sparse block(const Sparse& matrix, const DofRange& dofs) {
  return matrix.block(dofs.begin, dofs.begin, dofs.count, dofs.count);
}

// Spans of the same build at other places differ by rounding, also where an entry is zero.
bool alike(const Sparse& a, const Sparse& b) {
  constexpr double rounding = 1e-11;  // of the geometric mean of the diagonal's entries
  if (a.rows() != b.rows() || a.nonZeros() != b.nonZeros()) return false;
  const Eigen::ArrayXd scale = a.diagonal().cwiseAbs().cwiseSqrt();
  for (int j = 0; j < a.outerSize(); ++j) {
    Sparse::InnerIterator x(a, j), y(b, j);
    for (; x && y; ++x, ++y) {
      if (x.row() != y.row() || std::abs(x.value() - y.value()) > rounding * scale[x.row()] * scale[j]) return false;
    }
    if (x || y) return false;
  }
  return true;
}

/// The modes of spans, once for spans that are alike.
class SharedModes {
 public:
  const ModalBasis& of(const Sparse& stiffness, const Sparse& mass) {
    for (const Span& span : known_) {
      if (alike(span.stiffness, stiffness) && alike(span.mass, mass)) return span.modes;
    }
    known_.push_back({stiffness, mass, lowest_modes(stiffness, mass, span_modes, 1e-6)});
    return known_.back().modes;
  }

 private:
  struct Span {
    Sparse stiffness, mass;
    ModalBasis modes;
  };
  std::deque<Span> known_;
};

// Coordinates (0), velocities (1) or accelerations (2) of a span in VsiState::left_behind.
auto of_span(Eigen::VectorXd& numbers, Eigen::Index first, Eigen::Index modes, int derivative) {
  return numbers.segment(first + derivative * modes, modes);
}

void to_rest(LinearMotion& motion, Eigen::Index begin, Eigen::Index count) {
  for (Eigen::VectorXd* vector :
       {&motion.displacement, &motion.velocity, &motion.acceleration, &motion.contact_load, &motion.step_load})
    vector->segment(begin, count).setZero();
}

}  // namespace

Eigen::Index WindowModel::numbers() const noexcept {
  Eigen::Index sum = 0;
  for (const SpanModes& span : spans) sum += 3 * span.omega2.size();
  return sum;
}

WindowModel make_window(const StructureModel& structure, const ReductionParameters& parameters) {
  WindowModel window{parameters.ahead, parameters.behind, {}};
  SharedModes modes;
  for (const auto& [from, to] : structure.spans) {
    SpanModes span{from, to, dofs_between(structure.dof_x, from, to), {}, {}, {}, {}, {}};
    const ModalBasis& basis = modes.of(block(structure.stiffness, span.dofs), block(structure.mass, span.dofs));
    span.damping = (basis.shape.transpose() * (block(structure.damping, span.dofs) * basis.shape)).diagonal();
    if (structure.supports.carried.size() > 0) {
      const auto loads = [&](const StructureSupports::Columns& columns) -> Eigen::MatrixXd {
        return basis.shape.transpose() * Sparse(columns.middleRows(span.dofs.begin, span.dofs.count));
      };
      span.support_mass = loads(structure.supports.mass);
      span.support_damping = loads(structure.supports.damping);
    }
    span.shape = basis.shape;
    span.omega2 = basis.omega2;
    window.spans.push_back(std::move(span));
  }
  return window;
}

namespace {

// What motions that are sums and the channels of the deck need of a span; its ends belong to its neighbours too.
void add_followed(const StructureModel& structure, const SpanModes& span, std::vector<int>& dofs) {
  const DofRange inside = dofs_within(structure.dof_x, span.from, span.to);
  for (const auto* rows : {&structure.summed_nodes, &structure.deck.rows}) {
    for (Eigen::Index i = 0; i < rows->nonZeros(); ++i) {
      const int dof = rows->innerIndexPtr()[i];
      if (dof >= inside.begin && dof < inside.end()) dofs.push_back(dof);
    }
  }
  std::sort(dofs.begin(), dofs.end());
  dofs.erase(std::unique(dofs.begin(), dofs.end()), dofs.end());
}

}  // namespace

MovingWindow::MovingWindow(const VsiModel& model, double time_step)
    : model_(model), scheme_{.alpha = 0.0, .time_step = time_step} {
  for (const SpanModes& span : model.window->spans) {
    Followed& followed = followed_.emplace_back();
    std::vector<int>& dofs = followed.dofs;
    for (const StructureNode& node : model.structure->nodes) {
      if (node.x < span.from || node.x > span.to) continue;
      std::copy_if(node.dof.begin(), node.dof.end(), std::back_inserter(dofs),
                   [&](int dof) { return dof != held && dof >= span.dofs.begin && dof < span.dofs.end(); });
    }
    add_followed(*model.structure, span, dofs);
    compliance_.emplace_back(
        (scheme_.acceleration_rate() + scheme_.velocity_rate() * span.damping.array() + span.omega2.array()).inverse());
    const auto count = static_cast<Eigen::Index>(dofs.size());
    followed.shape.setZero((count + together - 1) / together * together, span.shape.cols());
    for (Eigen::Index i = 0; i < count; ++i) {
      followed.shape.row(i) = span.shape.row(dofs[static_cast<std::size_t>(i)] - span.dofs.begin);
    }
  }
}

// Both ends move at once, as the train passes a multiple of the stride: each move takes a new factor.
MovingWindow::Ends MovingWindow::ends(long step) const {
  const WindowModel& window = *model_.window;
  const double time = static_cast<double>(step) * scheme_.time_step;
  const int last = model_.wheelsets() - 1;
  const double length = model_.wheelset_x(0, 0.0) - model_.wheelset_x(last, 0.0);  // to the bit at all times
  const double stride = std::max(least_stride, share_of_window * (length + window.behind + window.ahead));
  const double passed = stride * std::floor(model_.wheelset_x(last, time) / stride);
  Ends ends{passed, passed + stride + length};
  const auto whole_spans = [&] {
    for (const SpanModes& span : window.spans) {
      if (span.from < ends.from && ends.from < span.to) ends.from = span.from;
      if (span.from < ends.to && ends.to < span.to) ends.to = span.to;
    }
  };
  // A span under load turns at its bearings and bends the rails there: the cut stands beyond its neighbour.
  whole_spans();
  ends.from -= window.behind;
  ends.to += window.ahead;
  whole_spans();
  return ends;
}

DofRange MovingWindow::largest(double duration) const {
  constexpr double spacing = 1.0;  // m, between positions of the train: a small part of the stride
  const double travel = model_.wheelset_x(0, duration) - model_.wheelset_x(0, 0.0);
  const double positions = std::max(1.0, std::ceil(travel / spacing));
  DofRange most;
  for (double k = 0.0; k <= positions; ++k) {
    const Ends at = ends(std::lround(k / positions * duration / scheme_.time_step));
    const DofRange range = dofs_between(model_.structure->dof_x, at.from, at.to);
    if (range.count > most.count) most = range;
  }
  return most;
}

DofRange MovingWindow::move(VsiState& state) {
  const long step = std::lround(state.time / scheme_.time_step);
  const Ends now = ends(step);
  const Ends before = ends(step - 1);
  const DofRange range = dofs_between(model_.structure->dof_x, now.from, now.to);
  from_ = now.from;
  to_ = now.to;
  if (placed_ && (now == before || step == moved_at_)) return range;
  LinearMotion& structure = state.structure.whole();
  const std::array motions{&structure.displacement, &structure.velocity, &structure.acceleration};
  Eigen::VectorXd lost = structure.displacement;  // what no mode keeps of it
  Eigen::Index first = 0;
  for (const SpanModes& span : model_.window->spans) {
    const Eigen::Index modes = span.omega2.size();
    if (before.from < span.to && span.to <= now.from) {
      const Sparse mass = block(model_.structure->mass, span.dofs);
      for (int derivative = 0; derivative < 3; ++derivative) {
        const Eigen::VectorXd momentum = mass * span.dofs.of(*motions[static_cast<std::size_t>(derivative)]);
        of_span(state.left_behind, first, modes, derivative) = span.shape.transpose() * momentum;
      }
      span.dofs.of(lost) -= span.shape * of_span(state.left_behind, first, modes, 0);
    }
    first += 3 * modes;
  }
  const DofRange old = dofs_between(model_.structure->dof_x, before.from, before.to);
  if (placed_) note_error(structure.displacement, lost, {old.begin, range.begin - old.begin}, before.to);
  const auto hold_outside = [&](const DofRange& inside) {  // where nodes of interest may have been written to
    to_rest(structure, 0, inside.begin);
    to_rest(structure, inside.end(), structure.displacement.size() - inside.end());
  };
  LinearMotion left;
  if (model_.ground_motion) {
    hold_outside(old);
    left = structure;
  }
  hold_outside(range);
  if (model_.ground_motion && now != before) join(old, before.to, left, range, state);
  placed_ = true;
  moved_at_ = step;
  return range;
}

// Behind the train, what no mode keeps is put to rest; at the front end it is the cut that holds.
void MovingWindow::note_error(const Eigen::VectorXd& motion, const Eigen::VectorXd& lost, const DofRange& behind,
                              double front) {
  constexpr double at_the_cut = 1.0;  // m, of a window that reaches 5 m at least
  const auto largest = [](const auto& part) { return part.size() == 0 ? 0.0 : part.cwiseAbs().maxCoeff(); };
  const double whole = largest(motion);
  if (!(whole > 0.0)) return;
  const DofRange at_front = dofs_between(model_.structure->dof_x, front - at_the_cut, front);
  error_ = std::max({error_, largest(behind.of(lost)) / whole, largest(at_front.of(motion)) / whole});
}

// Spans that come in while the ground shakes them meet with rails that each side had held to rest at the cut; joined as
// they are, the rails would load both with what the cut has held. And a span's few modes leave out that its track gives
// way to its own inertia. Both would ring: what comes in moves to where nothing is unbalanced, K Δw = −J, with J the
// forces by which the parts now act upon each other less those by which they did, and what is out of balance in the new
// ones. Ends of spans at one place belong to both ranges: what both have of them adds up, one of the two being next to
// nothing.
void MovingWindow::join(const DofRange& stayed, double was_to, const LinearMotion& left, const DofRange& range,
                        VsiState& state) const {
  const StructureModel& s = *model_.structure;
  LinearMotion& motion = state.structure.whole();
  const auto forces = [&](const Eigen::VectorXd& w, const Eigen::VectorXd& v) -> Eigen::VectorXd {
    return s.stiffness * w + s.damping * v;
  };
  const auto beyond = [&](const DofRange& part, Eigen::VectorXd f) {
    part.of(f).setZero();
    return f;
  };
  const Eigen::VectorXd lost = forces(left.displacement - motion.displacement, left.velocity - motion.velocity);
  Eigen::VectorXd unbalanced =
      beyond(stayed, lost) - lost + beyond(stayed, forces(motion.displacement, motion.velocity));
  Eigen::Index first = 0;
  for (const SpanModes& span : model_.window->spans) {
    const Eigen::Index modes = span.omega2.size();
    if (was_to <= span.from && span.to <= to_) {
      LinearMotion own(s.dofs());
      span.dofs.of(own.displacement) = span.shape * of_span(state.left_behind, first, modes, 0);
      span.dofs.of(own.velocity) = span.shape * of_span(state.left_behind, first, modes, 1);
      span.dofs.of(own.acceleration) = span.shape * of_span(state.left_behind, first, modes, 2);
      unbalanced += forces(own.displacement, own.velocity) + s.mass * own.acceleration;
      motion.displacement += own.displacement;
      motion.velocity += own.velocity;
      motion.acceleration += own.acceleration;
    }
    first += 3 * modes;
  }
  const SupportMotion supports = support_motion(*model_.ground_motion, s.supports.x, state.time);
  unbalanced += beyond(stayed, s.supports.mass * supports.acceleration + s.supports.damping * supports.velocity);
  motion.displacement -= SparseLdlt(s.stiffness, range).solve(unbalanced);
}

// Eq. 12 mode by mode. @param load of the modes; null: none
void MovingWindow::step_span(std::size_t index, Eigen::Index first, const Eigen::VectorXd* load,
                             VsiState& state) const {
  const SpanModes& span = model_.window->spans[index];
  const Eigen::Index modes = span.omega2.size();
  auto q = of_span(state.left_behind, first, modes, 0);
  auto v = of_span(state.left_behind, first, modes, 1);
  auto a = of_span(state.left_behind, first, modes, 2);
  const double dt = scheme_.time_step, of_a = dt * dt * (0.5 - scheme_.beta());
  using OfModes = Eigen::Array<double, Eigen::Dynamic, 1, Eigen::ColMajor, span_modes, 1>;
  const OfModes predicted = (q + dt * v + of_a * a).array();
  const OfModes velocity = (v + dt * (1.0 - scheme_.gamma()) * a).array();
  OfModes increment = -span.damping.array() * velocity - span.omega2.array() * predicted;
  if (load) increment += load->array();
  increment *= compliance_[index].array();
  q = (predicted + increment).matrix();
  v = (velocity + scheme_.velocity_rate() * increment).matrix();
  a = (scheme_.acceleration_rate() * increment).matrix();
  const Followed& followed = followed_[index];
  const Eigen::Map<const Eigen::MatrixX3d> coordinates(&state.left_behind[first], modes, 3);
  for (std::size_t i = 0; i < followed.dofs.size(); i += together) {
    const auto rows = followed.shape.middleRows<together>(static_cast<Eigen::Index>(i));
    const Eigen::Matrix<double, together, 3> motion = rows.lazyProduct(coordinates);
    for (std::size_t k = 0; k < together && i + k < followed.dofs.size(); ++k) {
      state.structure.set(followed.dofs[i + k], motion.row(static_cast<Eigen::Index>(k)));
    }
  }
}

void MovingWindow::step_inactive_spans(VsiState& state) const {
  SupportMotion supports;
  if (model_.ground_motion) supports = support_motion(*model_.ground_motion, model_.structure->supports.x, state.time);
  Eigen::Index first = 0;
  for (std::size_t i = 0; i < model_.window->spans.size(); ++i) {
    const SpanModes& span = model_.window->spans[i];
    const bool ahead = model_.ground_motion && span.from >= to_;
    if (span.to <= from_ || ahead) {
      if (model_.ground_motion) {
        const Eigen::VectorXd load =
            -(span.support_mass * supports.acceleration + span.support_damping * supports.velocity);
        step_span(i, first, &load, state);
      } else {
        step_span(i, first, nullptr, state);
      }
    }
    first += 3 * span.omega2.size();
  }
}

}  // namespace railtab
