#include "railtab/runtime/vsi/support_motion.hpp"

#include "railtab/runtime/structure/carried_motion.hpp"

namespace railtab {

SupportMotion support_motion(const GroundMotion& ground, const std::vector<double>& x, double time) {
  const auto rows = static_cast<Eigen::Index>(2 * x.size());
  SupportMotion motion{Eigen::VectorXd(rows), Eigen::VectorXd(rows), Eigen::VectorXd(rows)};
  GroundPoint point;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (i == 0 || !ground.uniform()) point = ground.at(x[i], time);
    const auto row = static_cast<Eigen::Index>(2 * i);
    motion.displacement.segment<2>(row) = point.displacement;
    motion.velocity.segment<2>(row) = point.velocity;
    motion.acceleration.segment<2>(row) = point.acceleration;
  }
  return motion;
}

CarriedHead carried_head(const RailContact& contact, const StructureSupports& supports,
                         const Eigen::VectorXd& translations) noexcept {
  CarriedHead head = CarriedHead::Zero();
  if (!contact.on_rail || supports.carried.size() == 0) return head;
  const RailInterpolation& r = contact.rows;
  for (std::size_t k = 0; k < 12; ++k) {
    if (r.dof[k] == held) continue;
    double carried = 0.0;
    for (StructureSupports::Columns::InnerIterator entry(supports.carried, r.dof[k]); entry; ++entry) {
      carried += entry.value() * translations[entry.col()];
    }
    head += carried * (CarriedHead() << r.y[k], r.z[k], r.roll[k], r.yaw[k], r.pitch[k], r.bend[k]).finished();
  }
  return head;
}

StructureSupports gathered(const StructureSupports& supports, const GroundMotion& ground) {
  std::vector<double> places = ground.places();
  if (places.empty()) return supports;
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t i = 0; i < supports.x.size(); ++i) {
    const Eigen::VectorXd share = ground.shares(supports.x[i]);
    for (Eigen::Index k = 0; k < share.size(); ++k) {
      for (int component = 0; component < 2; ++component) {
        const int row = static_cast<int>(2 * i) + component, column = static_cast<int>(2 * k) + component;
        if (share[k] != 0.0) entries.emplace_back(row, column, share[k]);
      }
    }
  }
  Eigen::SparseMatrix<double> shares(supports.columns(), static_cast<Eigen::Index>(2 * places.size()));
  shares.setFromTriplets(entries.begin(), entries.end());
  return gathered(supports, shares, std::move(places));
}

}  // namespace railtab
