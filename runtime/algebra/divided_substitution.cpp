#include "railtab/runtime/algebra/divided_substitution.hpp"

namespace railtab {

void DividedSubstitution::begin(const SparseLdlt& factor, const Eigen::VectorXd& known, std::span<const int> few) {
  begin(factor, few);
  factor.into(known, known_);
  factor.forward(known_);
}

void DividedSubstitution::begin(const SparseLdlt& factor, std::span<const int> few) {
  few_.assign(few.begin(), few.end());
  factor.find_path(few_, path_);
  if (work_.size() == factor.room()) return;
  for (Eigen::VectorXd* vector : {&known_, &work_, &solved_}) vector->setZero(factor.room());
}

void DividedSubstitution::respond(const SparseLdlt& factor, Eigen::VectorXd& solution) {
  factor.backward(known_, solved_, path_);
  for (int unknown : few_) solution[unknown] = solved_[factor.position(unknown)];
}

void DividedSubstitution::respond(const SparseLdlt& factor, double weight, const Eigen::VectorXd& extra,
                                  Eigen::VectorXd& solution) {
  factor.visit(path_, [&](int first, int columns) { work_.segment(first, columns).setZero(); });
  for (int unknown : few_) work_[factor.position(unknown)] = weight * extra[unknown];
  factor.forward(work_, path_);
  factor.visit(path_, [&](int first, int columns) { work_.segment(first, columns) += known_.segment(first, columns); });
  factor.backward(work_, solved_, path_);
  for (int unknown : few_) solution[unknown] = solved_[factor.position(unknown)];
}

void DividedSubstitution::finish(const SparseLdlt& factor, Eigen::VectorXd& solution) {
  factor.backward_off(path_, known_, solved_);
  factor.out_of(solved_, solution);
}

}  // namespace railtab
