#pragma once

#include "railtab/runtime/contact/creep_law.hpp"

namespace railtab::python {

struct Law {
  CreepLaw law;
};

}  // namespace railtab::python
