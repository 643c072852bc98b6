#include "railtab/tablegen/creep_shard_file.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "../folder_fixture.hpp"
#include "railtab/runtime/base/input_error.hpp"

namespace railtab {
namespace {

class CreepShardFile : public testing::InFolder {
 protected:
  /// The message with which a shard of such cases is not written, or rejected though its seal is right.
  [[nodiscard]] std::string message_for(const std::vector<SolvedCreepCase>& solved, double poisson = 0.28) const {
    CreepShardHeader header;
    header.job.layout.poisson = poisson;
    header.job.shard = TableShard{1, 2};
    header.case_list = "0123456789abcdef";
    header.cases = 4;
    const std::filesystem::path file = folder_ / "shard.h5";
    try {
      write_creep_shard(file, header, solved);
      EXPECT_EQ(read_creep_shard(file, creep_shard_filetype).solved.size(), solved.size());
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }
};

TEST_F(CreepShardFile, CasesThatDoNotAgreeWithItsHeaderAreNamed) {
  EXPECT_EQ(message_for(std::vector<SolvedCreepCase>(4)), "");
  const std::string message = message_for(std::vector<SolvedCreepCase>(3));
  EXPECT_NE(message.find("shard.h5: force_x: found the shape (3), expected (4 cases as in options)"), std::string::npos)
      << message;
}

TEST_F(CreepShardFile, NumbersThatAreNotFiniteAreNamed) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<SolvedCreepCase> solved(4);
  solved[2].force.moment = nan;
  EXPECT_NE(message_for(solved).find("moment: value 2 is nan, not a finite"), std::string::npos) << message_for(solved);
  solved[2].force.moment = 0.0;
  EXPECT_NE(message_for(solved, nan).find("options, attribute poisson: found nan"), std::string::npos);
}

}  // namespace
}  // namespace railtab
