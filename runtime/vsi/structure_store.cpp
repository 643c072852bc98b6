#include "railtab/runtime/vsi/structure_store.hpp"

#include <algorithm>
#include <span>

#include "railtab/runtime/vsi/operator_room.hpp"

namespace railtab {

namespace {

using Sparse = Eigen::SparseMatrix<double>;

bool equal(const Sparse& a, const Sparse& b) {
  if (a.rows() != b.rows() || a.cols() != b.cols() || !a.isCompressed() || !b.isCompressed()) return false;
  const auto same = [](const auto* x, const auto* y, Eigen::Index count) { return std::equal(x, x + count, y); };
  return a.nonZeros() == b.nonZeros() && same(a.outerIndexPtr(), b.outerIndexPtr(), a.outerSize() + 1) &&
         same(a.innerIndexPtr(), b.innerIndexPtr(), a.nonZeros()) && same(a.valuePtr(), b.valuePtr(), a.nonZeros());
}

bool equal(const RailLine& a, const RailLine& b) {
  return a.x == b.x && a.dof == b.dof && a.head_height == b.head_height && a.stiffness == b.stiffness &&
         a.twist_rate == b.twist_rate;
}

// What responses are made of: matrices, rails, places of the unknowns.
bool equal(const StructureModel& a, const StructureModel& b) {
  return equal(a.mass, b.mass) && equal(a.damping, b.damping) && equal(a.stiffness, b.stiffness) &&
         equal(a.rail[0], b.rail[0]) && equal(a.rail[1], b.rail[1]) && a.dof_x == b.dof_x && a.dof_line == b.dof_line &&
         a.dof_node == b.dof_node;
}

}  // namespace

void StructureStore::take_up(const SharedStructure& structure) {
  if (last_.lock() == structure) return;
  if (!structure_ || !equal(*structure_, *structure)) {
    at_rest_.reset();
    of_steps_.clear();
    matrices_ = {};
    structure_ = structure;
  }
  last_ = structure;
}

std::shared_ptr<StructureResponse> StructureStore::at_rest(const SharedStructure& structure) {
  take_up(structure);
  if (!at_rest_) at_rest_ = std::make_shared<StructureResponse>(structure_);
  return at_rest_;
}

std::shared_ptr<StructureResponse> StructureStore::of_steps(const SharedStructure& structure, const HhtScheme& scheme,
                                                            const DofRange& active) {
  take_up(structure);
  const bool all = active.count == structure->dofs();
  const auto found = std::find_if(of_steps_.begin(), of_steps_.end(), [&](const OfSteps& kept) {
    return kept.alpha == scheme.alpha && kept.time_step == scheme.time_step && kept.all_active == all;
  });
  if (found == of_steps_.end()) {
    OperatorRoom room;
    for (const OfSteps& kept : of_steps_) room.add(static_cast<double>(kept.response->bytes()));
    if (!room.for_another()) of_steps_.erase(of_steps_.begin());
    std::shared_ptr<const StepMatrices>& matrices = matrices_[all ? 1 : 0];
    if (!matrices) matrices = std::make_shared<const StepMatrices>(structure_, all);
    of_steps_.push_back(
        {scheme.alpha, scheme.time_step, all, std::make_shared<StructureResponse>(matrices, scheme, active)});
    of_steps_.back().response->keep_for_later_runs();
  } else {
    std::rotate(found, found + 1, of_steps_.end());
    if (active.count > 0) of_steps_.back().response->activate(active);
  }
  return of_steps_.back().response;
}

}  // namespace railtab
