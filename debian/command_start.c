/* /usr/bin/COMMAND of the packages: executes the build of the command for the best instruction set of the processor.
   /usr/libexec/railtab/x86-64-vN/COMMAND is the build for one of them. */
#include <stdio.h>
#include <unistd.h>

#define BUILD(level) "/usr/libexec/railtab/" level "/" COMMAND

int main(int argc, char** argv) {
  (void)argc;
  if (__builtin_cpu_supports("x86-64-v4")) execv(BUILD("x86-64-v4"), argv);
  if (__builtin_cpu_supports("x86-64-v3")) execv(BUILD("x86-64-v3"), argv);
  execv(BUILD("x86-64-v2"), argv);
  perror(BUILD("x86-64-v2"));
  return 1;
}
