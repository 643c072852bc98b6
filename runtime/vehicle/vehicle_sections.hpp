#pragma once

#include <string>
#include <vector>

#include "railtab/runtime/vehicle/toml_section.hpp"
#include "railtab/runtime/vehicle/vehicle_data.hpp"

namespace railtab {

// Ranges are wide: a value outside is in another unit or a slip of the pen.
inline constexpr NumberKind mass_kind{"kg", 1.0, 1e6}, inertia_kind{"kg m²", 0.1, 1e9},
    stiffness_kind{"N/m", 0.0, 1e12}, damping_kind{"N s/m", 0.0, 1e9}, bending_kind{"N m/rad", 0.0, 1e12},
    distance_kind{"m", 0.05, 100.0}, height_kind{"m", -1.0, 10.0}, position_kind{"m", -100.0, 100.0},
    radius_kind{"m", 0.05, 2.0}, speed_kind{"km/h", 1.0, 1000.0}, force_kind{"N", 0.0, 1e7}, ratio_kind{"", 0.0, 1.0},
    moment_kind{"N m", 0.0, 1e7}, travel_kind{"m", 1e-6, 0.1}, angle_kind{"rad", 1e-6, 0.1},
    friction_ratio_kind{"", 0.0, 10.0}, frequency_kind{"Hz", 0.0, 1e3};

/// The keys kx … cz, series_k*, damper_curve_*, stop_* and friction_* of a spring-damper. Vertical data have those of z
/// alone. What is not linear is described in data.nonlinear, data.linearised and data.left_out under `name`.
[[nodiscard]] SuspensionUnit read_unit(TomlSection& section, const std::string& name, VehicleData& data);

/// mass, Jx, Jy, Jz; vertical data have no Jx and Jz, which then act on nothing.
[[nodiscard]] BodyInertia read_inertia(TomlSection& section, const VehicleData& data);

/// The same of a wheelset, of which vertical data have the mass alone.
[[nodiscard]] BodyInertia read_wheelset(TomlSection& section, const VehicleData& data);

/// [bogie], [layout], [primary], [secondary] and [roll_bar] of the template "two-bogie".
void read_two_bogie(TomlSection& root, VehicleData& data);

/// Name, description, provenance, motion and nominal radius.
void read_heading(TomlSection& root, VehicleData& data);

/// Wheelsets at their positions x.
void read_wheelsets(TomlSection& section, VehicleData& data);

/// [car_body], [wheelset] with its positions and the bodies of [[body]]. A vehicle that stands on its joints may have
/// no wheelset.
void read_bodies(TomlSection& root, VehicleData& data);

/// [[connection]], which joins bodies that are there.
void read_connections(TomlSection& root, VehicleData& data);

/// One [[body]] for each of its positions.
void read_further_bodies(TomlSection& root, VehicleData& data);

}  // namespace railtab
