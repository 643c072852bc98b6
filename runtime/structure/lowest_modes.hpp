#pragma once

#include <Eigen/SparseCore>

namespace railtab {

/// M-orthonormal modes, Φᵀ M Φ = I and Φᵀ K Φ = Λ, lowest first.
struct ModalBasis {
  Eigen::MatrixXd shape;   ///< Φ, degrees of freedom × modes
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

/// Residual flexibility: shapes that deflect under forces as all motions beyond the modes do. Of the forces E, one per
/// column, the modes lack R = K⁻¹E − Φ Λ⁻¹ Φᵀ E. With EᵀR = V diag(a) Vᵀ the shapes are Ψ = ω R V diag(a)^(−1/2), ω
/// that of the last mode, so that Ψ Ψᵀ E/ω² = R. They are orthogonal to the modes, and Ψᵀ K Ψ = ω².
/// @return one column per a that is not below 1e-5 of the largest deflection at a force
/// @throws ComputationError where K is not positive definite
[[nodiscard]] Eigen::MatrixXd residual_shapes(const Eigen::SparseMatrix<double>& stiffness, const ModalBasis& modes,
                                              const Eigen::MatrixXd& forces);

}  // namespace railtab
