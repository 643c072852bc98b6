#include <boost/program_options/errors.hpp>

#include "batch_list.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/tablegen/creep_shard_file.hpp"
#include "reading.hpp"

namespace railtab::fuzz {

void read_batch_file(const Path& file) {
  for (const BatchPair& pair : read_batch_list(file)) {
    try {
      static_cast<void>(geometry_options_text(pair.arguments));
    } catch (const boost::program_options::error&) {  // as batch_command.cpp takes it
    }
  }
}

void read_creep_partial(const Path& file) {
  static_cast<void>(read_creep_shard(file, creep_partial_filetype).header.named());
}

void write_creep_partial_seed(const Path& file) {
  CreepShardHeader header;
  header.program_version = "0.1.0";
  header.case_list = "00";
  header.cases = 10;
  ArrayFileWriter out = create_creep_partial(file, header);
  append(out, std::vector<SolvedCreepCase>(4));
  out.close();
}

}  // namespace railtab::fuzz
