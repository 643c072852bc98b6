# cmake -D OUTPUT=FILE.cpp -D FUNCTION=name -D HEADER=railtab/… -D FILE=page.js -P EmbedText.cmake: a text file as a
# source. HEADER declares `std::string_view FUNCTION()` in the namespace railtab::report.
file(READ ${FILE} text)
set(source "// Generated.\n#include \"${HEADER}\"\n\nnamespace railtab::report {\n\nstd::string_view ${FUNCTION}() {\n")
string(APPEND source "  return R\"text(${text})text\";\n}\n\n}  // namespace railtab::report\n")
file(WRITE ${OUTPUT} "${source}")
