#pragma once

#include "railtab/runtime/contact/creep_law.hpp"

namespace railtab {

/// Exact rolling contact by look-up, blended into Polach at the table's border. @see creep_force
[[nodiscard]] CreepForce table_creep(const TableCreep& law, double ratio, const Creepage& creepage) noexcept;

}  // namespace railtab
