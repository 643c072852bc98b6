#pragma once

#include <Eigen/Core>

namespace railtab {

/// Motion of two bodies, or nodes, a and b: [u_a, θ_a, u_b, θ_b], each in the order x, y, z, roll, pitch, yaw.
using PairMatrix = Eigen::Matrix<double, 12, 12>;
using SpringKinematics = Eigen::Matrix<double, 6, 12>;

/// Small motion of the attachment point on b relative to that on a: rows 0–2 relative displacement [m], rows 3–5
/// relative rotation [rad]. With arm r from a reference point to the attachment, u_point = u + θ × r, so
/// row block = [-I, [r_a]×, I, -[r_b]×] over [-, -I, -, I].
/// @param arm_a, arm_b from the reference point of a, b to the attachment, axes x, y, z [m]
[[nodiscard]] SpringKinematics spring_kinematics(const Eigen::Vector3d& arm_a, const Eigen::Vector3d& arm_b);

/// B^T·diag(along, about)·B: stiffness matrix of a spring, or damping matrix of a damper; symmetric, 12 × 12.
/// @param along per translation x, y, z [N/m] or [N s/m]
/// @param about per rotation x, y, z [N m/rad] or [N m s/rad]
[[nodiscard]] PairMatrix spring_matrix(const Eigen::Vector3d& arm_a, const Eigen::Vector3d& arm_b,
                                       const Eigen::Vector3d& along, const Eigen::Vector3d& about);

/// Stiffness of a spring that carries the force f between a and b at rest, besides that of its elasticity. The spring's
/// axes turn by the mean θ_m of the rotations of its ends, so that turning a and b together costs nothing:
///   V = f·(½ θ_b×(θ_b×r_b) − ½ θ_a×(θ_a×r_a) − θ_m×e),  e = u_b + θ_b×r_b − u_a − θ_a×r_a.
/// A vertical load N that an upper body b has moved aside by e_y thereby turns both bodies by N·e_y, shared as θ_m is,
/// and its own height over the spring by N·h φ.
/// @param force on a, as the spring exerts it at rest, that on b is its negative [N]
/// @param share_b part of b in θ_m about x, y, z, 0..1 each; that of a is the rest
/// @return second derivative of V, symmetric, 12 × 12 [N], [N], [N m]
[[nodiscard]] PairMatrix preload_matrix(const Eigen::Vector3d& arm_a, const Eigen::Vector3d& arm_b,
                                        const Eigen::Vector3d& force, const Eigen::Vector3d& share_b);

}  // namespace railtab
