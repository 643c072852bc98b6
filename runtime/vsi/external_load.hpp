#pragma once

#include <Eigen/Core>

#include "railtab/runtime/vsi/linear_motion.hpp"
#include "railtab/runtime/vsi/vsi_model.hpp"

namespace railtab {

/// Loads at `time` on one vehicle besides gravity and the contacts: those of `VsiModel::loads`, and where the train
/// accelerates the inertia of bodies that are described in its frame, −m dV/dt along x and, of wheelsets whose nominal
/// rotation −V/R0 changes, J_y/R0·dV/dt about y. @param load is set, one per dof
void vehicle_load(const VsiModel& model, int vehicle, double time, Eigen::VectorXd& load);

/// What a step from `time` applies to one vehicle besides the contacts: gravity, (1+α)F(t+Δt) − αF(t) of
/// vehicle_load(), and what the gyroscopic moments at the step's begin differ by from those at its end, whose speed the
/// step's damping matrix has.
void vehicle_step_load(const VsiModel& model, const HhtScheme& scheme, int vehicle, double time,
                       const LinearMotion& motion, Eigen::VectorXd& load);

/// Add what the supports' motion applies to the structure's unknowns in `range` in a step from `time`: with
/// f = −(M_s s'' + C_s s' + K_s s), the load (1+α)f(t+Δt) − αf(t) (docs/theory/loads.md). Nothing without ground
/// motion.
void add_ground_load(const VsiModel& model, const HhtScheme& scheme, double time, const DofRange& range,
                     Eigen::VectorXd& load);

}  // namespace railtab
