#pragma once

#include <string_view>

#include "railtab/runtime/structure/structure_model.hpp"

namespace railtab {

enum class Reduction { none, modal, craig_bampton, window };
/// "none", "modal", "craig-bampton", "window"
[[nodiscard]] std::string_view reduction_name(Reduction reduction) noexcept;

/// How a structure is made smaller for the steps.
struct ReductionParameters {
  Reduction kind = Reduction::none;
  int modes = 200;                ///< modal: of the structure; craig-bampton: of each part, 1..2000
  bool static_correction = true;  ///< modal: the modes left out answer without inertia
  double ahead = 20.0;            ///< window: track before the first wheelset and its span [m]
  double behind = 20.0;           ///< window: track behind the last wheelset and its span [m]
  void validate() const;          ///< @throws InputError
};

/// M-orthonormal modes, Φᵀ M Φ = I and Φᵀ K Φ = Λ, lowest first.
struct ModalBasis {
  Eigen::MatrixXd shape;   ///< Φ, unknowns × modes
  Eigen::VectorXd omega2;  ///< Λ [rad²/s²]
};
/// The lowest modes of K φ = ω² M φ by block Lanczos iteration with K⁻¹ and full orthogonalisation
/// [GrimesLewisSimon1994]; fewer where the matrices have fewer. Starts from fixed pseudo-random numbers: the same call
/// gives the same modes.
/// @param tolerance residual of K⁻¹ M φ − φ/ω² relative to 1/ω²
/// @return modes that have converged, at least one
/// @throws ComputationError where K is not positive definite, and where modes do not converge
[[nodiscard]] ModalBasis lowest_modes(const Eigen::SparseMatrix<double>& stiffness,
                                      const Eigen::SparseMatrix<double>& mass, int modes, double tolerance = 1e-8);

/// The structure in its lowest modes: unknowns are modal coordinates, M = I, K = Λ, C = Φᵀ C Φ. In this and the next
/// supports stay where displacements are relative to them (relative_to_supports()), and stand still else.
[[nodiscard]] StructureModel reduce_to_modes(const StructureModel& structure, int modes);

/// Craig–Bampton [CraigBampton1968]: rails stay, and every part that hangs together without the rails (a span with its
/// sleepers) is described by its static answers to the rails and `modes` modes with the rails held. Parts with fewer
/// unknowns than that stay as they are.
[[nodiscard]] StructureModel reduce_parts(const StructureModel& structure, int modes);

}  // namespace railtab
