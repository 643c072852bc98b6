#pragma once

namespace railtab {

/// How wheels stand on rails vertically.
enum class NormalContact {
  hertz,  ///< Hertz's contact force (Eq. 11) of every patch, with creep forces and loss of contact
  /// A wheelset follows the mean of its two rails, irregularity included, as if glued to them: constraint of Eq. 14
  /// with its first two time derivatives. The lean choice for vertical questions: no contact geometry, no creep forces,
  /// no lateral load, and no loss of contact (a negative wheel load says where there would be one).
  rigid,
};

}  // namespace railtab
