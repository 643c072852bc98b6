/* /usr/bin/COMMAND of the packages: executes the build of the command for the best instruction set of the processor.
   /usr/libexec/railtab/x86-64-vN/COMMAND is the build for one of them. */
#include <stdio.h>
#include <unistd.h>

int main(int argc, char** argv) {
  (void)argc;
  const char* const program = __builtin_cpu_supports("x86-64-v4")   ? "/usr/libexec/railtab/x86-64-v4/" COMMAND
                              : __builtin_cpu_supports("x86-64-v3") ? "/usr/libexec/railtab/x86-64-v3/" COMMAND
                                                                    : "/usr/libexec/railtab/x86-64-v2/" COMMAND;
  execv(program, argv);
  perror(program);
  return 1;
}
