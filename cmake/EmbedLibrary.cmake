# cmake -D OUTPUT=FILE.cpp -D FUNCTION=name -D HEADER=railtab/… -D FILES=a.toml;b.toml -P EmbedLibrary.cmake: a folder
# library/*.toml as a source. HEADER declares `const std::vector<LibraryFile>& FUNCTION()`.
set(source "// Generated from library/*.toml.\n#include \"${HEADER}\"\n\n")
string(APPEND source "namespace railtab {\n\nconst std::vector<LibraryFile>& ${FUNCTION}() {\n")
string(APPEND source "  static const std::vector<LibraryFile> files{\n")
foreach(file IN LISTS FILES)
  cmake_path(GET file STEM name)
  file(READ ${file} text)
  string(APPEND source "      {\"${name}\", R\"toml(${text})toml\"},\n")
endforeach()
string(APPEND source "  };\n  return files;\n}\n\n}  // namespace railtab\n")
file(WRITE ${OUTPUT} "${source}")
