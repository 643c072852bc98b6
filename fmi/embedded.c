#include "embedded.h"

#define EMBED(name, file)             \
  __asm__(                            \
      ".section .rodata\n"            \
      ".balign 16\n"                  \
      ".global " name "_begin\n" name \
      "_begin:\n"                     \
      ".incbin \"" file               \
      "\"\n"                          \
      ".global " name "_end\n" name   \
      "_end:\n"                       \
      ".byte 0\n"                     \
      ".previous\n")

EMBED("railtab_fmu_library", RAILTAB_FMU_LIBRARY);
EMBED("railtab_license", RAILTAB_LICENSE);
