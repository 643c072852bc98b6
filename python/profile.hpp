#pragma once

#include "railtab/runtime/profile/profile_curve.hpp"

namespace railtab::python {

struct Profile {
  ProfileCurve curve;
};

}  // namespace railtab::python
