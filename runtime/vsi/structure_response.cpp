#include "railtab/runtime/vsi/structure_response.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>
#include <numeric>
#include <utility>

#include "railtab/runtime/algebra/section_layout.hpp"
#include "railtab/runtime/algebra/sectioned_ldlt.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/pack.hpp"

namespace railtab {

namespace {

constexpr double most_kept = 64.0 * 1024.0 * 1024.0;  // bytes, of compliances and of factors: keep_for_later_runs()

using Sparse = Eigen::SparseMatrix<double>;

SharedStructure not_owned(const StructureModel& structure) { return {SharedStructure(), &structure}; }

constexpr const char* not_positive_definite =
    "the structure's effective matrix is not positive definite: check supports and stiffnesses";

// The compliance of (y, z, roll) of rail heads on a symmetric structure seen in a mirror along the track.
Eigen::Matrix3d mirrored(const Eigen::Matrix3d& compliance) {
  Eigen::Matrix3d result = compliance;
  for (const int odd : {0, 2}) {
    result(odd, 1) = -compliance(odd, 1);
    result(1, odd) = -compliance(1, odd);
  }
  return result;
}

}  // namespace

/// Few entries of solutions.
struct StructureResponse::FewEntries {
  DividedSubstitution solution{};
  Eigen::VectorXd load, displacement;  // of all unknowns; the load is zero between uses

  explicit FewEntries(Eigen::Index dofs) : load(Eigen::VectorXd::Zero(dofs)), displacement(load) {}
  /// Displacement of the unknowns named in DividedSubstitution::begin() under the load.
  const Eigen::VectorXd& respond(const SubstitutionFactor& factor) {
    solution.respond(factor, 1.0, load, displacement);
    return displacement;
  }
};

StructureResponse::StructureResponse(const StructureModel& structure, const HhtScheme& scheme)
    : StructureResponse(structure, scheme, {0, structure.dofs()}) {}

StructureResponse::StructureResponse(const StructureModel& structure, const HhtScheme& scheme, const DofRange& active)
    : StructureResponse(std::make_shared<const StepMatrices>(not_owned(structure), active.count == structure.dofs()),
                        scheme, active) {}

StructureResponse::StructureResponse(std::shared_ptr<const StepMatrices> matrices, const HhtScheme& scheme,
                                     const DofRange& active)
    : scheme_(scheme),
      structure_(matrices->structure()),
      matrices_(std::move(matrices)),
      divisible_(matrices_->divisible()),
      dofs_(structure_->dofs()),
      rails_mirror_(matrices_->rails_mirror()) {
  if (active.count > 0) activate(active);
}

StructureResponse::StructureResponse(const StructureModel& structure) : StructureResponse(not_owned(structure)) {}

StructureResponse::StructureResponse(SharedStructure structure)
    : structure_(std::move(structure)), at_rest_(true), dofs_(structure_->dofs()) {
  require_finite(*structure_);
  activate({0, dofs_});
}

StructureResponse::~StructureResponse() = default;

void StructureResponse::activate(const DofRange& dofs) {
  if (factor_ && active_ == dofs) return;
  std::optional<Kept> wanted;
  const auto known = std::find_if(kept_.begin(), kept_.end(), [&](const Kept& kept) { return kept.active == dofs; });
  if (known != kept_.end()) {
    wanted = std::move(*known);
    kept_.erase(known);
  }
  leave_factor();
  active_ = dofs;
  if (!wanted) return make_factor();
  factor_ = std::move(wanted->factor);
  product_ = std::move(wanted->product);
}

void StructureResponse::leave_factor() {
  if (factor_ && keeps_) {
    const std::size_t bytes = factor_->stored_bytes() + (product_ ? product_->bytes() : 0);
    const std::size_t of_others = std::accumulate(kept_.begin(), kept_.end(), std::size_t{0},
                                                  [](std::size_t sum, const Kept& kept) { return sum + kept.bytes; });
    if (static_cast<double>(bytes + of_others) <= most_kept) {
      kept_.push_back({active_, std::move(factor_), std::move(product_), bytes});
    }
  }
  factor_.reset();  // not two at a time
  product_.reset();
}

void StructureResponse::make_factor() {
  const DofRange& dofs = active_;
  if (divisible_) {
    bool inaccurate = false;
    const Sparse effective = matrices_->divided(scheme_, dofs);
    if (auto layout = divide(effective, matrices_->places(), matrices_->pairs(), dofs)) {
      const auto shared = std::make_shared<const SectionLayout>(std::move(*layout));
      if (auto factor = accurate_sections(effective, shared)) {
        product_ = std::make_unique<SectionedProduct>(matrices_->stiffness(), matrices_->damping(), shared);
        factor_ = std::move(factor);
        return;
      }
      inaccurate = true;
    }
    if (own_product_.empty()) own_product_ = PairedProduct(structure_->stiffness, structure_->damping);
    if (inaccurate) divisible_ = false;  // nor would sections of another window be accurate
  }
  factor_ = undivided_factor(dofs, order_of_steps());
}

std::unique_ptr<SparseLdlt> StructureResponse::undivided_factor(const DofRange& dofs, EliminationOrder order) const {
  const auto make = [&](const Sparse& matrix) {
    return std::make_unique<SparseLdlt>(matrix, dofs, not_positive_definite, order, structure_->dof_node);
  };
  if (at_rest_) return make(structure_->stiffness);
  Sparse effective = effective_matrix(*structure_, scheme_, dofs);
  effective.data().squeeze();  // a sum of sparse matrices may have room for twice its entries
  return make(effective);
}

// The rounding of the sections' factor to single precision acts as an added mass of either sign, up to 6e-8 of a
// diagonal entry. Elements much shorter than a wave are so stiff that, in long steps, this is not small beside their
// own mass. It shows in a translation, which bends no element: where that is off by 1e-3, the motions of a deck under a
// train are off by some 1e-5.
std::unique_ptr<SubstitutionFactor> StructureResponse::accurate_sections(
    const Sparse& effective, const std::shared_ptr<const SectionLayout>& layout) const {
  constexpr double most = 1e-3;  // of the translation
  constexpr int translations = 3;
  std::unique_ptr<SubstitutionFactor> factor;
  try {
    factor = std::make_unique<SectionedLdlt>(effective, layout, not_positive_definite);
  } catch (const ComputationError&) {
    return nullptr;  // by the rounding, or the factor of the whole says so
  }
  Eigen::VectorXd moved = Eigen::VectorXd::Zero(dofs_), load = moved;
  for (Eigen::Index i = active_.begin; i < active_.end(); ++i) {
    if (structure_->dof_line[static_cast<std::size_t>(i)] % lines_per_node < translations) moved[i] = 1.0;
  }
  const auto add = [&](const Sparse& matrix, double weight) {
    visit_entries(matrix, active_,
                  [&](Eigen::Index i, Eigen::Index j, double value) { load[i] += weight * value * moved[j]; });
  };
  add(structure_->mass, scheme_.acceleration_rate());
  add(structure_->damping, scheme_.load_weight() * scheme_.velocity_rate());
  add(structure_->stiffness, scheme_.load_weight());
  const Eigen::VectorXd solution = factor->solve(load);
  for (Eigen::Index i = active_.begin; i < active_.end(); ++i) {
    if (moved[i] != 0.0 && !(std::abs(solution[i] - 1.0) < most)) return nullptr;  // a NaN, too
  }
  return factor;
}

// The factor of all unknowns serves the compliances, too, whose paths should be short; one at rest or of a window soon
// goes.
EliminationOrder StructureResponse::order_of_steps() const noexcept {
  return active_.count == dofs_ && !at_rest_ ? EliminationOrder::nested_dissection : EliminationOrder::minimum_degree;
}

// Where steps have other unknowns at other times, compliances may not depend on those of the moment.
bool StructureResponse::steps_give_compliances() const noexcept {
  return !product_ && active_.count == dofs_ && (at_rest_ || matrices_->all_active() || stretches() == 1);
}

namespace {

double longest_element(const RailLine& rail) {
  double longest = 0.0;
  for (std::size_t i = 1; i < rail.x.size(); ++i) longest = std::max(longest, rail.x[i] - rail.x[i - 1]);
  return longest;
}

double longest_element(const StructureModel& structure) {
  return std::max(longest_element(structure.rail[0]), longest_element(structure.rail[1]));
}

constexpr double stretch_length = 1000.0;  // m
constexpr double stretch_margin = 50.0;    // m: what happens so far away does not reach a rail head within a step

}  // namespace

int StructureResponse::stretches() const noexcept {
  const auto& x = structure_->dof_x;
  return x.empty() ? 1 : std::max(1, static_cast<int>((x.back() - x.front()) / stretch_length));
}

int StructureResponse::stretch_at(double x) const noexcept {
  const int last = stretches() - 1;
  if (last == 0) return 0;
  return std::clamp(static_cast<int>((x - structure_->dof_x.front()) / stretch_length), 0, last);
}

// All unknowns where there is one stretch alone. Decks are not cut: modes are all at one place.
DofRange StructureResponse::dofs_of_stretch(int stretch, double reach) const {
  const auto& x = structure_->dof_x;
  const int last = stretches() - 1;
  if (last == 0) return {0, dofs_};
  const double begin = x.front() + stretch * stretch_length, margin = stretch_margin + reach;
  double from = stretch == 0 ? x.front() : begin - margin,
         to = stretch == last ? x.back() : begin + stretch_length + margin;
  const double within_from = from, within_to = to;
  for (const auto& [span_from, span_to] : structure_->spans) {
    if (span_to < within_from || span_from > within_to) continue;
    from = std::min(from, span_from);
    to = std::max(to, span_to);
  }
  return dofs_between(x, from, to);
}

const SubstitutionFactor& StructureResponse::compliance_factor(double x, double reach) {
  if (steps_give_compliances()) return *factor_;
  const int stretch = stretch_at(x);
  if (!of_stretch_ || stretch != stretch_) {
    of_stretch_.reset();  // not two at a time
    of_stretch_ = undivided_factor(dofs_of_stretch(stretch, reach), EliminationOrder::nested_dissection);
    stretch_ = stretch;
  }
  return *of_stretch_;
}

std::size_t StructureResponse::few_bytes() const noexcept {
  constexpr std::size_t vectors = 6;  // load and displacement, and those of the substitution
  return vectors * sizeof(double) * static_cast<std::size_t>(dofs_);
}

std::size_t StructureResponse::bytes() const noexcept {
  std::size_t sum = own_product_.bytes() + (factor_ ? factor_->stored_bytes() : 0) +
                    (product_ ? product_->bytes() : 0) + (of_stretch_ ? of_stretch_->stored_bytes() : 0) +
                    (few_ ? few_bytes() : 0);
  for (const Kept& kept : kept_) sum += kept.bytes;
  for (const std::vector<Column>& columns : column_) {
    sum += columns.capacity() * sizeof(Column);
    for (const Column& column : columns) {
      for (const std::vector<Block>& rows : column.rows) sum += rows.capacity() * sizeof(Block);
    }
  }
  return sum;
}

StructureResponse::Memory StructureResponse::memory() const {
  const auto n = static_cast<double>(dofs_);
  const auto bytes_of = [&](const Sparse& matrix) {
    return (sizeof(double) + sizeof(int)) * static_cast<double>(matrix.nonZeros()) + sizeof(int) * n;
  };
  // A factor, and the matrix that it is made of.
  const auto undivided = [&](const DofRange& dofs, EliminationOrder order) {
    const auto factor = [&](const Sparse& matrix) {
      return SparseLdlt::memory(matrix, dofs, order, structure_->dof_node);
    };
    if (at_rest_) return std::pair(factor(structure_->stiffness), 0.0);
    const Sparse effective = effective_matrix(*structure_, scheme_, dofs);
    return std::pair(factor(effective), bytes_of(effective));
  };
  Memory memory;
  if (matrices_) {
    // Of a matrix by sums and differences: its entries as triplets, and transposed.
    constexpr double per_entry = 2.0 * sizeof(int) + sizeof(double) + sizeof(int) + sizeof(double);
    memory.shared = static_cast<double>(matrices_->bytes());
    memory.shared_setup = per_entry * static_cast<double>(structure_->stiffness.nonZeros());
  }
  memory.kept = static_cast<double>(factor_->stored_bytes() + own_product_.bytes()) +
                static_cast<double>(product_ ? product_->bytes() : 0);
  memory.low = static_cast<double>(few_bytes());
  if (steps_give_compliances()) {
    const auto [factor, matrix] = undivided(active_, order_of_steps());
    memory.setup = static_cast<double>(factor.made) + matrix;
    memory.low_entries = static_cast<double>(factor.entries);
    memory.low_unknowns = n;
    return memory;
  }
  double stored = 0.0;
  const double reach = longest_element(*structure_);
  for (int stretch = 0; stretch < stretches(); ++stretch) {
    const DofRange dofs = dofs_of_stretch(stretch, reach);
    const auto [factor, matrix] = undivided(dofs, EliminationOrder::nested_dissection);
    stored = std::max(stored, static_cast<double>(factor.stored));
    memory.low_setup = std::max(memory.low_setup, static_cast<double>(factor.made) + matrix);
    memory.low_entries += static_cast<double>(factor.entries);
    memory.low_unknowns += static_cast<double>(dofs.count);
  }
  memory.low += stored;
  if (product_) {
    const double matrix = bytes_of(effective_matrix(*structure_, scheme_, active_));
    // An estimate of what the division into sections works on beside the matrix: copies of the pattern, or its entries
    // and the factor's, twice as wide until they are stored, beside the factor.
    memory.setup = 2.0 * matrix + std::max(3.5 * matrix, matrix + 2.0 * static_cast<double>(factor_->bytes()));
  } else {
    const auto [factor, matrix] = undivided(active_, order_of_steps());
    memory.setup = matrix + static_cast<double>(factor.made);
  }
  return memory;
}

namespace {

// A wheel loads both nodes of its element, and is always coupled to them, however long the element is.
double reach_of(const StructureModel& structure, double window) { return std::max(window, longest_element(structure)); }

// Most nodes of a rail within `reach` of a position on it.
std::size_t most_nodes(const RailLine& rail, double reach) {
  std::size_t most = 0, first = 0;
  for (std::size_t i = 0; i < rail.x.size(); ++i) {
    while (rail.x[i] - rail.x[first] > 2.0 * reach) ++first;
    most = std::max(most, i + 1 - first);
  }
  return most;
}

}  // namespace

double StructureResponse::table_bytes(double window, double from, double to) const {
  double bytes = 0.0;
  for (const RailLine& rail : std::span(structure_->rail).first(tabulated_rails())) {
    const double longest = longest_element(rail), reach = reach_of(*structure_, window);
    double blocks = 0.0;
    for (const RailLine& other : structure_->rail) blocks += static_cast<double>(most_nodes(other, reach));
    const auto columns =
        std::count_if(rail.x.begin(), rail.x.end(), [&](double x) { return x >= from - longest && x <= to + longest; });
    bytes +=
        static_cast<double>(rail.x.size()) * sizeof(Column) + static_cast<double>(columns) * blocks * sizeof(Block);
  }
  return bytes;
}

void StructureResponse::begin_step(const StructureMotion& motion, const KnownLoad& load, const LoadedUnknowns& few,
                                   StructureSolution& solution) const {
  assert(load.at || load.weight == 1.0);
  if (product_) {
    SectionedProduct::Motion& predicted = motion.predicted(predictor_, product_->layout());
    solution.substitution.begin_with(*factor_, few, [&](Eigen::VectorXd& known) {
      if (load.at) {
        factor_->into(*load.at, load.weight, load.vector, known);
      } else {
        factor_->into(load.vector, known);
      }
      product_->subtract(predicted, known);
    });
    return;
  }
  auto& [u, v] = solution.motion;
  solution.load.resize(dofs_);
  active_.of(solution.load) = load.weight * active_.of(load.vector);
  u.resize(dofs_);
  v.resize(dofs_);
  const LinearMotion& begin = motion.whole();
  predictor_.predict(active_.of(begin.displacement), active_.of(begin.velocity), active_.of(begin.acceleration),
                     active_.of(u), active_.of(v));
  paired_product().subtract(u.data(), v.data(), active_, solution.load.data());
  solution.substitution.begin(*factor_, solution.load, few);
}

void StructureResponse::finish_step(StructureSolution& solution, StructureMotion& motion) const {
  assert(!at_rest_);
  if (product_) {
    motion.end_step(scheme_, predictor_, solution.substitution.finish(*factor_));
    return;
  }
  solution.increment.resize(dofs_);
  solution.substitution.finish(*factor_, solution.increment);
  update(scheme_, solution.increment, active_, motion.whole());
}

Eigen::VectorXd StructureResponse::increment(const LinearMotion& motion, const Eigen::VectorXd& load) const {
  StructureSolution solution;
  Eigen::VectorXd result = Eigen::VectorXd::Zero(dofs_);
  begin_step(StructureMotion(motion), {load}, {}, solution);
  solution.substitution.respond(*factor_, result);
  solution.substitution.finish(*factor_, result);
  return result;
}

std::size_t StructureResponse::load_bytes() const noexcept {
  assert(!at_rest_);
  return product_ ? product_->bytes() : paired_product().bytes();
}

StructureResponse::Column StructureResponse::column_of(double reach, std::size_t side, std::size_t node,
                                                       const std::array<std::size_t, 2>& room) {
  const RailLine& rail = structure_->rail[side];
  const SubstitutionFactor& factor = compliance_factor(rail.x[node], reach);
  FewEntries& s = *few_;
  Column column;
  std::vector<int> involved;
  const DofIndices unknowns = head_dofs(rail, node);
  append_free(unknowns, involved);
  for (std::size_t other = 0; other < 2; ++other) {
    const RailLine& to = structure_->rail[other];
    const auto begin = std::lower_bound(to.x.begin(), to.x.end(), rail.x[node] - reach) - to.x.begin();
    const auto end = std::upper_bound(to.x.begin(), to.x.end(), rail.x[node] + reach) - to.x.begin();
    column.first[other] = static_cast<int>(begin);
    column.rows[other].reserve(room[other]);
    column.rows[other].assign(static_cast<std::size_t>(end - begin), Block::Zero());
    for (auto n = begin; n < end; ++n) append_free(head_dofs(to, static_cast<std::size_t>(n)), involved);
  }
  s.solution.begin(factor, {involved, {}});
  for (std::size_t load = 0; load < 6; ++load) {
    const int loaded = unknowns[load];
    if (loaded == held) continue;
    s.load[loaded] = 1.0;
    const Eigen::VectorXd& moved = s.respond(factor);
    s.load[loaded] = 0.0;
    for (std::size_t other = 0; other < 2; ++other) {
      const auto first = static_cast<std::size_t>(column.first[other]);
      for (std::size_t n = 0; n < column.rows[other].size(); ++n) {
        const DofIndices dofs = head_dofs(structure_->rail[other], first + n);
        for (std::size_t k = 0; k < 6; ++k) {
          if (dofs[k] == held) continue;
          column.rows[other][n](static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(load)) = moved[dofs[k]];
        }
      }
    }
  }
  return column;
}

void StructureResponse::tabulate_compliance(double window, double from, double to) {
  if (!few_) few_ = std::make_unique<FewEntries>(dofs_);
  const RailLine& line = structure_->rail[0];
  const bool keeps = keeps_ && table_bytes(window, line.x.front(), line.x.back()) <= most_kept;
  const auto visit = [&](auto&& visitor) {
    for (std::size_t side = 0; side < tabulated_rails(); ++side) {
      const RailLine& rail = structure_->rail[side];
      const double longest = longest_element(rail);
      for (std::size_t node = 0; node < rail.x.size(); ++node) {
        visitor(side, node, rail.x[node] >= from - longest && rail.x[node] <= to + longest);
      }
    }
  };
  // New columns take the place of those that are dropped before: all have the room of the largest.
  visit([&](std::size_t side, std::size_t node, bool covered) {
    column_[side].resize(structure_->rail[side].x.size());
    if (!covered && !keeps) column_[side][node] = {};
  });
  const double reach = reach_of(*structure_, window);
  const std::array<std::size_t, 2> room{most_nodes(structure_->rail[0], reach), most_nodes(structure_->rail[1], reach)};
  visit([&](std::size_t side, std::size_t node, bool covered) {
    if (!covered || !column_[side][node].rows[side].empty()) return;
    column_[side][node] = column_of(reach, side, node, room);
  });
}

template <class Visitor>
void StructureResponse::visit_blocks(const RailContact& i, const RailContact& j, Visitor&& visitor) const noexcept {
  if (!i.on_rail || !j.on_rail) return;
  const auto row_side = static_cast<std::size_t>(by_mirror(j) ? opposite(i.side) : i.side);
  const auto column_side = static_cast<std::size_t>(by_mirror(j) ? RailSide::left : j.side);
  for (int q = 0; q < 2; ++q) {
    const Column& from = column_[column_side][static_cast<std::size_t>(j.element + q)];
    assert(!from.rows[column_side].empty() && "the table does not cover this position");
    const auto count = static_cast<int>(from.rows[row_side].size());
    for (int p = 0; p < 2; ++p) {
      const int offset = i.element + p - from.first[row_side];
      if (offset >= 0 && offset < count) {
        visitor(from.rows[row_side][static_cast<std::size_t>(offset)], static_cast<std::size_t>(6 * p),
                static_cast<std::size_t>(6 * q));
      }
    }
  }
}

namespace {

// Twist rate, y, z, roll, pitch and yaw of a node: the first four and the last four.
struct NodeMotion {
  Pack first{}, last{};

  void add(double weight, const double* column) noexcept {
    Pack moved;
    std::memcpy(&moved, column, sizeof moved);
    first += weight * moved;
    std::memcpy(&moved, column + 2, sizeof moved);
    last += weight * moved;
  }
  void add(double weight, const NodeMotion& other) noexcept {
    first += weight * other.first;
    last += weight * other.last;
  }
};

// Of a node's motion in that of a rail head, whose y, z and roll are sums of two each.
struct HeadWeights {
  Pack first, last;

  /// @param node where the node's unknowns begin in the rows
  HeadWeights(const RailInterpolation& r, std::size_t node) noexcept
      : first{r.roll[node + twist], r.y[node + y], r.z[node + z], r.roll[node + roll]},
        last{0.0, 0.0, r.z[node + pitch], r.y[node + yaw]} {}

 private:
  using enum HeadDof::Place;
};

}  // namespace

Eigen::Matrix3d StructureResponse::compliance(const RailContact& i, const RailContact& j) const noexcept {
  using enum HeadDof::Place;
  if (!i.on_rail || !j.on_rail) return Eigen::Matrix3d::Zero();
  NodeMotion node[2][3];  // of i, under unit loads y, z and roll on rail head j
  visit_blocks(i, j, [&](const Block& block, std::size_t p, std::size_t q) {
    const RailInterpolation& c = j.rows;
    const auto column = [&](std::size_t k) { return block.data() + of_node * k; };
    auto& [of_y, of_z, of_roll] = node[p / of_node];
    of_y.add(c.y[q + y], column(y));
    of_y.add(c.y[q + yaw], column(yaw));
    of_z.add(c.z[q + z], column(z));
    of_z.add(c.z[q + pitch], column(pitch));
    of_roll.add(c.roll[q + roll], column(roll));
    of_roll.add(c.roll[q + twist], column(twist));
  });
  const HeadWeights begin(i.rows, 0), end(i.rows, of_node);
  Eigen::Matrix3d result;
  for (std::size_t p = 0; p < 2; ++p) node[p][0].add(j.rail->head_height, node[p][2]);
  for (Eigen::Index load = 0; load < 3; ++load) {
    const NodeMotion &at_begin = node[0][load], &at_end = node[1][load];
    const Pack first = begin.first * at_begin.first + end.first * at_end.first;
    const Pack last = begin.last * at_begin.last + end.last * at_end.last;
    // of y and yaw, z and pitch, twist rate and roll
    const Pack moved =
        __builtin_shufflevector(first, first, 1, 2, 0, 0) + __builtin_shufflevector(first, last, 7, 6, 3, 3);
    result.col(load) << moved[0] + i.rail->head_height * moved[2], moved[1], moved[2];
  }
  return by_mirror(j) ? mirrored(result) : result;
}

RailHeadsCompliance StructureResponse::compliance(RailHeads i, RailHeads j) const noexcept {
  assert(i[0].x == i[1].x && j[0].x == j[1].x);
  const Eigen::Matrix3d left = compliance(i[0], j[0]), right = compliance(i[1], j[0]);
  RailHeadsCompliance result;
  result.leftCols<3>() << left, right;
  if (rails_mirror_) {
    result.rightCols<3>() << mirrored(right), mirrored(left);
  } else {
    result.rightCols<3>() << compliance(i[0], j[1]), compliance(i[1], j[1]);
  }
  return result;
}

Eigen::Vector3d StructureResponse::vertical_compliance(const RailContact& i, const RailContact& j) const noexcept {
  using Row = Eigen::Matrix<double, 1, 6>;
  Eigen::Vector3d result = Eigen::Vector3d::Zero();
  // z and pitch, the only unknowns of these rows, are the same in a mirror.
  visit_blocks(i, j, [&](const Block& block, std::size_t p, std::size_t q) {
    const Eigen::Matrix<double, 6, 1> moved = block * Row::Map(&j.rows.z[q]).transpose();
    result += Eigen::Vector3d(Row::Map(&i.rows.z[p]) * moved, -Row::Map(&i.rows.pitch[p]) * moved,
                              Row::Map(&i.rows.bend[p]) * moved);
  });
  return result;
}

Eigen::MatrixXd StructureResponse::compliance_at(const std::vector<RailContact>& contacts) {
  const auto n = static_cast<Eigen::Index>(contacts.size());
  FewEntries s(dofs_);
  std::vector<int> involved;
  for (const RailContact& contact : contacts) append_dofs(contact, involved);
  s.solution.begin(*factor_, {involved, {}});
  Eigen::MatrixXd result(3 * n, 3 * n);
  for (Eigen::Index j = 0; j < 3 * n; ++j) {
    const RailContact& loaded = contacts[static_cast<std::size_t>(j / 3)];
    add_rail_load(loaded, Eigen::Vector3d::Unit(j % 3), s.load);
    const Eigen::VectorXd& moved = s.respond(*factor_);
    for (Eigen::Index i = 0; i < n; ++i) {
      result.block<3, 1>(3 * i, j) = rail_head(contacts[static_cast<std::size_t>(i)], moved);
    }
    for (int dof : involved) s.load[dof] = 0.0;
  }
  return result;
}

}  // namespace railtab
