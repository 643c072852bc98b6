#include "railtab/runtime/algebra/divided_substitution.hpp"

#include <algorithm>

namespace railtab {

void DividedSubstitution::begin(const SubstitutionFactor& factor, const LoadedUnknowns& few) {
  const bool of_another = path_of_ != factor.id(), same = !of_another && std::ranges::equal(few.now, few_);
  if (!same) {
    few_.assign(few.now.begin(), few.now.end());
    if (of_another || !factor.covers(path_, few_)) {
      path_of_ = 0;  // of none, should the search throw
      on_path_ = few_;
      on_path_.insert(on_path_.end(), few.soon.begin(), few.soon.end());
      factor.find_path(on_path_, path_);
      path_of_ = factor.id();
    }
  }
  if (!of_another && work_.size() == factor.room()) return;
  for (Eigen::VectorXd* vector : {&known_, &work_, &solved_}) vector->setZero(factor.room());
}

void DividedSubstitution::begin(const SubstitutionFactor& factor, const Eigen::VectorXd& known,
                                const LoadedUnknowns& few) {
  begin(factor, few);
  factor.into(known, known_);
  factor.forward(known_);
}

void DividedSubstitution::respond(const SubstitutionFactor& factor, Eigen::VectorXd& solution) {
  factor.backward(known_, solved_, path_);
  factor.read(few_, solved_, solution);
}

void DividedSubstitution::respond(const SubstitutionFactor& factor, double weight, const Eigen::VectorXd& extra,
                                  Eigen::VectorXd& solution) {
  factor.load(path_, few_, weight, extra, work_);
  factor.forward(work_, path_, known_);
  factor.backward(work_, solved_, path_);
  factor.read(few_, solved_, solution);
}

void DividedSubstitution::finish(const SubstitutionFactor& factor, Eigen::VectorXd& solution) {
  factor.out_of(finish(factor), solution);
}

const Eigen::VectorXd& DividedSubstitution::finish(const SubstitutionFactor& factor) {
  factor.backward_off(path_, known_, solved_);
  return solved_;
}

}  // namespace railtab
