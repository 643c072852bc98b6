#include "command/command_table.hpp"
#include "commands.hpp"
#include "railtab/runtime/base/process_end.hpp"

namespace railtab {

namespace {

using Arguments = std::vector<std::string>;

/// A command that has failed has thrown.
std::function<int(const Arguments&)> done_after(void (*command)(const Arguments&)) {
  return [command](const Arguments& arguments) {
    command(arguments);
    return exit_code::done;
  };
}

const CommandTable& commands() {
  static const CommandTable table{
      "tablegen",
      "make tables of wheel-rail contact",
      "",
      {{"geometry", "--wheel P --rail P -o FILE.h5", "make a contact geometry table of a wheel and a rail profile",
        done_after(geometry_command)},
       {"batch", "LIST.toml", "make the geometry tables of a list of wheel and rail pairs", done_after(batch_command)},
       {"creep", "[--shard I/N] -o FILE.h5",
        "make a table of creep forces by exact rolling contact, or one shard of it", done_after(creep_command)},
       {"merge", "SHARD.h5... -o FILE.h5", "combine the shards of a table", done_after(merge_command)},
       {"contact", "[--wheel P --rail P] [options]",
        "solve one contact of a wheel on its rail, or one exact rolling contact of an ellipse",
        done_after(contact_command)},
       {"conicity", "FILE.h5 | --wheel P --rail P", "rolling radius difference and equivalent conicity (EN 15302)",
        done_after(conicity_command)},
       {"loaded", "FILE.h5", "add the loaded contact (half-space solutions over all poses) to a geometry table",
        done_after(loaded_command)},
       {"info", "FILE.h5 [--html PAGE.html]", "print the contents of a table", done_after(info_command)},
       {"verify", "FILE.h5", "compare a table with the online search: errors, share of fallback, time per query",
        done_after(verify_command)}},
      {{exit_code::done, "done"},
       {exit_code::failed, "the computation failed"},
       {exit_code::wrong_input, "the input is wrong"}}};
  return table;
}

}  // namespace

}  // namespace railtab

int main(int argc, char** argv) {
  return railtab::run_process("tablegen", [&] {
    return railtab::run_command_table(railtab::commands(), {argv + 1, argv + argc});
  });
}
