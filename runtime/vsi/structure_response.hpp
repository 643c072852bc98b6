#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "railtab/runtime/algebra/divided_substitution.hpp"
#include "railtab/runtime/algebra/elimination_order.hpp"
#include "railtab/runtime/algebra/paired_product.hpp"
#include "railtab/runtime/algebra/sectioned_product.hpp"
#include "railtab/runtime/algebra/sparse_ldlt.hpp"
#include "railtab/runtime/structure/structure_model.hpp"
#include "railtab/runtime/vsi/rail_contact.hpp"
#include "railtab/runtime/vsi/step_matrices.hpp"
#include "railtab/runtime/vsi/structure_motion.hpp"

namespace railtab {

/// A load on the structure; refers to the vector, and is not kept.
struct KnownLoad {
  const Eigen::VectorXd& vector;  ///< of all unknowns
  /// Active unknowns but for which it is zero, some perhaps twice; none: any.
  std::optional<std::span<const int>> at = std::nullopt;
  double weight = 1.0;  ///< of the vector, where `at` is given
};

/// Buffers of the structure's solution of one step, reused.
struct StructureSolution {
  DividedSubstitution substitution;
  SectionedProduct::Motion motion;  ///< (1+α)ã − αa(t), (1+α)ṽ − αv(t) of a structure that is not in sections
  Eigen::VectorXd load, increment;
};

/// The structure for one time-step size: the factor of its effective matrix, made once for every range of active
/// unknowns. Long tracks and bridges are factored in sections side by side, anything else as a whole.
class StructureResponse {
 public:
  /// @param structure outlives this
  /// @throws InputError naming the matrix and the entry that is not finite; ComputationError where the effective matrix
  ///         is not positive definite.
  StructureResponse(const StructureModel& structure, const HhtScheme& scheme);
  /// @param active the unknowns that take part; none: there is no factor until activate()
  StructureResponse(const StructureModel& structure, const HhtScheme& scheme, const DofRange& active);
  /// The same of matrices that steps of other sizes share.
  StructureResponse(std::shared_ptr<const StepMatrices> matrices, const HhtScheme& scheme, const DofRange& active);
  /// At rest: K̄ = K, factored as a whole.
  explicit StructureResponse(SharedStructure structure);
  explicit StructureResponse(const StructureModel& structure);
  ~StructureResponse();

  [[nodiscard]] const SubstitutionFactor& factor() const noexcept { return *factor_; }
  /// Whether the active unknowns are factored in sections.
  [[nodiscard]] bool in_sections() const noexcept { return product_ != nullptr; }
  /// Whether a symmetric structure carries both rails, as far as its lines tell: only the left one's compliances are
  /// tabulated then.
  [[nodiscard]] bool rails_mirror() const noexcept { return rails_mirror_; }
  /// That of the constructor. @pre not at rest
  [[nodiscard]] const HhtScheme& scheme() const noexcept { return scheme_; }

  /// Let only these unknowns take part: the others are held at rest. At first all take part. Makes a new factor, where
  /// none of them is kept.
  void activate(const DofRange& dofs);
  [[nodiscard]] const DofRange& active() const noexcept { return active_; }

  /// The forward half of Eq. 13 without contact forces at the end of the step. Not at rest.
  /// @param motion at the beginning of the step
  /// @param load what does not come from the motion: past_contact_load() and others
  /// @param few unknowns that the contact forces stand on, or soon will @pre all of them are active
  void begin_step(const StructureMotion& motion, const KnownLoad& load, const LoadedUnknowns& few,
                  StructureSolution& solution) const;
  /// Ends such a step under the loads of the last respond(): displacement, velocity and acceleration of the active
  /// unknowns. @pre begin_step() of this response, then respond() @param motion that of begin_step()
  void finish_step(StructureSolution& solution, StructureMotion& motion) const;
  /// Brings a motion into the order in which these steps leave it.
  void bring_in_order(StructureMotion& motion) const {
    if (product_) static_cast<void>(motion.in_order(product_->layout()));
  }
  /// The increment of such a step without contacts.
  [[nodiscard]] Eigen::VectorXd increment(const LinearMotion& motion, const Eigen::VectorXd& load) const;
  /// What begin_step() reads of stiffness and damping [bytes]. Not at rest.
  [[nodiscard]] std::size_t load_bytes() const noexcept;

  /// Memory of a run's operator [bytes]. Those of compliances are counted, not made.
  struct Memory {
    double shared = 0.0;        ///< matrices, once for steps of all sizes
    double shared_setup = 0.0;  ///< besides that while they are made
    double kept = 0.0;          ///< factor and what begin_step() reads besides
    double setup = 0.0;         ///< besides that while the factor is made
    double low = 0.0;           ///< the largest factor that compliances come from, with its solver
    double low_setup = 0.0;
    double low_entries = 0.0, low_unknowns = 0.0;  ///< of all of them
  };
  [[nodiscard]] Memory memory() const;
  /// What there is now of factors, products and compliances [bytes].
  [[nodiscard]] std::size_t bytes() const noexcept;
  /// Of a table of compliances with the train between positions `from` and `to` [bytes].
  [[nodiscard]] double table_bytes(double window, double from, double to) const;

  [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& load) const { return factor_->solve(load); }

  /// Make the table of node-by-node compliances cover loads on the rails between positions `from` and `to` [m], coupled
  /// within `window` [m] on either side (at least one element). What it has already is kept, what lies outside is
  /// dropped: a moving train takes its table along, at a cost that does not depend on the track's length.
  void tabulate_compliance(double window, double from, double to);
  /// For trains that will run there again, from now on nothing is dropped from that table, and factors of other active
  /// unknowns wait for activate(), as far as either takes no more than 64 MiB.
  void keep_for_later_runs() noexcept { keeps_ = true; }
  /// Displacement of rail head `i` from unit loads on rail head `j` (3×3), from the tabulated compliance; zero where
  /// the two are farther apart than the window: what that leaves out is put right by the step's own residual.
  /// @pre the table covers `j`
  [[nodiscard]] Eigen::Matrix3d compliance(const RailContact& i, const RailContact& j) const noexcept;
  /// The same of the rail heads under two wheelsets. @pre the table covers `j`; both wheels of each stand at one x
  [[nodiscard]] RailHeadsCompliance compliance(RailHeads i, RailHeads j) const noexcept;

  /// Vertical displacement z, slope dz/dx and curvature d²z/dx² of rail `i` from a unit vertical load on rail `j`, from
  /// the same table.
  [[nodiscard]] Eigen::Vector3d vertical_compliance(const RailContact& i, const RailContact& j) const noexcept;

  /// The same without tabulation, by solving for the columns of every contact (3n × 3n): exact, for few positions.
  [[nodiscard]] Eigen::MatrixXd compliance_at(const std::vector<RailContact>& contacts);

 private:
  /// Not aligned: the allocator finds no freed place again for what asks to be.
  using Block = Eigen::Matrix<double, 6, 6, Eigen::DontAlign>;
  /// Compliances of one node; empty where the table does not cover it.
  struct Column {
    std::array<int, 2> first{};              // first node of the window on each rail
    std::array<std::vector<Block>, 2> rows;  // displacement of the window's nodes from unit loads on this node
  };
  /// Calls visitor(block, first row, first column) for the tabulated compliances between the nodes of the elements of i
  /// and j; row and column within the 12 unknowns of either element.
  template <class Visitor>
  void visit_blocks(const RailContact& i, const RailContact& j, Visitor&& visitor) const noexcept;
  /// @param reach distance to the outermost nodes of the column [m] @param room of the column, blocks per rail
  [[nodiscard]] Column column_of(double reach, std::size_t side, std::size_t node,
                                 const std::array<std::size_t, 2>& room);

  using Sparse = StepMatrices::Sparse;
  /// Of the effective matrix as it is.
  [[nodiscard]] std::unique_ptr<SparseLdlt> undivided_factor(const DofRange& dofs, EliminationOrder order) const;
  /// The factor in sections of the active unknowns; null where its rounding would show.
  [[nodiscard]] std::unique_ptr<SubstitutionFactor> accurate_sections(
      const Sparse& effective, const std::shared_ptr<const SectionLayout>& layout) const;
  /// Puts away the factor of the active unknowns, or drops it.
  void leave_factor();
  void make_factor();

  HhtScheme scheme_{};
  WeightedPredictor predictor_{scheme_};
  SharedStructure structure_;
  std::shared_ptr<const StepMatrices> matrices_;  ///< null at rest
  bool divisible_ = false;                        ///< not, either, where a factor in sections was not accurate
  std::unique_ptr<SubstitutionFactor> factor_;
  std::unique_ptr<SectionedProduct> product_;  ///< null: not in sections
  DofRange active_;
  /// What belongs to other active unknowns.
  struct Kept {
    DofRange active;
    std::unique_ptr<SubstitutionFactor> factor;
    std::unique_ptr<SectionedProduct> product;
    std::size_t bytes;
  };
  std::vector<Kept> kept_;
  PairedProduct own_product_;  ///< where the matrices have none and there are no sections
  [[nodiscard]] const PairedProduct& paired_product() const noexcept {
    return own_product_.empty() ? matrices_->product() : own_product_;
  }
  [[nodiscard]] EliminationOrder order_of_steps() const noexcept;
  [[nodiscard]] bool steps_give_compliances() const noexcept;
  /// Compliances come from the factor of the steps where that is always of all unknowns, else from one of the stretch
  /// of line that a node stands on, with some track before and behind it: what a compliance is to the last bit depends
  /// on the place alone. @param reach from the node to the farthest unknown that is asked for [m]
  [[nodiscard]] const SubstitutionFactor& compliance_factor(double x, double reach);
  [[nodiscard]] int stretches() const noexcept;
  [[nodiscard]] int stretch_at(double x) const noexcept;
  [[nodiscard]] DofRange dofs_of_stretch(int stretch, double reach) const;
  std::unique_ptr<SparseLdlt> of_stretch_;  ///< made when first needed
  int stretch_ = -1;
  struct FewEntries;
  [[nodiscard]] std::size_t few_bytes() const noexcept;
  std::unique_ptr<FewEntries> few_;
  bool at_rest_ = false;
  Eigen::Index dofs_ = 0;
  /// Per rail and node. Where the rails mirror each other: of the left one only.
  std::array<std::vector<Column>, 2> column_;
  bool rails_mirror_ = false;
  [[nodiscard]] std::size_t tabulated_rails() const noexcept { return rails_mirror_ ? 1 : 2; }
  /// Whether a load's compliances come from the table of the other rail.
  [[nodiscard]] bool by_mirror(const RailContact& loaded) const noexcept {
    return rails_mirror_ && loaded.side == RailSide::right;
  }
  bool keeps_ = false;
};

}  // namespace railtab
