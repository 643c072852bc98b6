#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <vector>

namespace railtab {

/// Lateral (y, to the right) and vertical (z, down) component of the ground's motion.
using GroundVector = Eigen::Vector2d;

struct GroundState {
  GroundVector displacement = GroundVector::Zero();  ///< [m]
  GroundVector velocity = GroundVector::Zero();      ///< [m/s]
  GroundVector acceleration = GroundVector::Zero();  ///< [m/s²]
};

/// Motion of the ground at one place over time. Between its points the acceleration is a straight line, velocity and
/// displacement are its exact integrals, so that the three belong together. The ground is at rest with displacement
/// zero before the first point, and at rest where it has come to after the last.
class GroundRecord {
 public:
  /// From accelerations [m/s²]: a straight line over time is added to each component so that the ground ends at rest
  /// where it began, since what a record's integrals drift by is not motion.
  /// @param time strictly increasing [s], at least 2 points @throws InputError naming the point
  [[nodiscard]] static GroundRecord from_acceleration(std::vector<double> time, std::vector<GroundVector> acceleration);
  /// From displacements [m], counted from the first one: the cubic spline that begins and ends at rest. It may end at
  /// another place.
  [[nodiscard]] static GroundRecord from_displacement(std::vector<double> time,
                                                      const std::vector<GroundVector>& displacement);

  [[nodiscard]] GroundState at(double time) const noexcept;
  /// Largest acceleration that was added against drift, per component; zero for displacements [m/s²].
  [[nodiscard]] const GroundVector& drift_correction() const noexcept { return drift_correction_; }
  /// Largest acceleration per component, as it was given (before the correction) and as it acts [m/s²]. Of
  /// displacements both are the spline's.
  [[nodiscard]] const GroundVector& given_peak() const noexcept { return given_peak_; }
  [[nodiscard]] GroundVector peak() const noexcept;
  [[nodiscard]] double begin() const noexcept { return time_.front(); }
  [[nodiscard]] double end() const noexcept { return time_.back(); }
  struct LongestInterval {
    double begin, length, usual;  ///< [s]; usual: the median of all
  };
  /// The longest between two neighbouring points.
  [[nodiscard]] LongestInterval longest_interval() const;
  /// Move the record in time [s] and scale it.
  void shift(double time) noexcept;
  void scale(double factor) noexcept;

 private:
  GroundRecord(std::vector<double> time, std::vector<GroundVector> acceleration);
  void integrate();

  std::vector<double> time_;
  std::vector<GroundVector> acceleration_, velocity_, displacement_;  // at the points
  GroundVector drift_correction_ = GroundVector::Zero(), given_peak_ = GroundVector::Zero();
};

/// Read a ground record: first column t[s], then y and z, one of them or both, as accelerations in [m/s2] or [g] or as
/// displacements in [m] or [mm] (docs/file_formats/histories.md). @throws InputError with file and line
[[nodiscard]] GroundRecord read_ground_record(const std::filesystem::path& file);

}  // namespace railtab
