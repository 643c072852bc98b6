#include "railtab/runtime/base/process_end.hpp"

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <new>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/text_file.hpp"

namespace railtab {

namespace {

constexpr int done = 0, failed = 1, wrong_input = 2;

int caught(std::string_view program, const std::function<int()>& command) {
  // no formatting that could throw once more: memory or standard error may be what is missing
  const auto say = [program](const char* what, const char* detail = nullptr) {
    std::fprintf(stderr, "%.*s: %s%s%s\n", static_cast<int>(program.size()), program.data(), what,
                 detail == nullptr ? "" : ": ", detail == nullptr ? "" : detail);
  };
  try {
    return command();
  } catch (const InputError& wrong) {
    say(wrong.what());
    return wrong_input;
  } catch (const std::filesystem::filesystem_error& refused) {
    say(refused.path1().c_str(), refused.code().message().c_str());
    return is_wrong_name(refused.code()) ? wrong_input : failed;
  } catch (const std::bad_alloc&) {
    say("not enough memory");
    return failed;
  } catch (const std::exception& failure) {
    say(failure.what());
    return failed;
  }
}

}  // namespace

void print_message(const std::string& text) noexcept { std::fputs(text.c_str(), stderr); }

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
