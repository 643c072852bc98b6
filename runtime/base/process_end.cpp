#include "railtab/runtime/base/process_end.hpp"

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <new>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/printable_text.hpp"
#include "railtab/runtime/base/text_file.hpp"

namespace railtab {

namespace {

using exit_code::done, exit_code::failed, exit_code::wrong_input;

/// Without memory of its own, which may be what is missing.
void write_printable(std::string_view text, std::FILE* stream) noexcept {
  for (std::size_t begin = 0; begin < text.size();) {
    std::size_t end = begin;
    while (const std::size_t bytes = printable_bytes(text.substr(end))) end += bytes;
    std::fwrite(text.data() + begin, 1, end - begin, stream);
    if (end < text.size())
      std::fprintf(stream, "\\x%02X", static_cast<unsigned>(static_cast<unsigned char>(text[end])));
    begin = end + 1;
  }
}

int caught(std::string_view program, const std::function<int()>& command) {
  // no formatting that could throw once more: memory or standard error may be what is missing
  const auto say = [program](const char* what, const char* detail = nullptr) {
    for (const std::string_view part :
         {program, std::string_view(": "), std::string_view(what), std::string_view(detail == nullptr ? "" : ": "),
          std::string_view(detail == nullptr ? "" : detail), std::string_view("\n")}) {
      print_message(part);
    }
  };
  try {
    return command();
  } catch (const InputError& wrong) {
    say(wrong.what());
    return wrong_input;
  } catch (const std::filesystem::filesystem_error& rejected) {
    say(rejected.path1().c_str(), rejected.code().message().c_str());
    return is_wrong_name(rejected.code()) ? wrong_input : failed;
  } catch (const std::bad_alloc&) {
    say("not enough memory");
    return failed;
  } catch (const std::exception& failure) {
    say(failure.what());
    return failed;
  }
}

}  // namespace

void print_message(std::string_view text) noexcept { write_printable(text, stderr); }

void print_text(std::string_view text) noexcept { write_printable(text, stdout); }

int run_process(std::string_view program, const std::function<int()>& command) {
  int code = caught(program, command);
  // What was asked for on standard output has to have arrived there.
  if (code == done && (std::fflush(stdout) != 0 || std::ferror(stdout) != 0)) {
    std::fprintf(stderr, "%.*s: standard output could not be written\n", static_cast<int>(program.size()),
                 program.data());
    code = failed;
  }
  if (code == done) return done;
  std::fflush(nullptr);
  std::_Exit(code);
}

}  // namespace railtab
