# Writes OUTPUT, a C++ file that holds the texts of FILES (paths from ROOT, separated by |). Literals end in sv, which knows
# their length: counting it in a constant expression exceeds the steps that clang allows.
string(REPLACE "|" ";" FILES "${FILES}")
set(text "// Made by host/base/embed.cmake.\n#include \"host/base/embedded.h\"\n\nnamespace kilolux {\nnamespace {\n\nusing namespace std::string_view_literals;\n\nconstexpr EmbeddedFile kFiles[] = {\n")
foreach(file IN LISTS FILES)
  file(READ "${ROOT}/${file}" content)
  string(APPEND text "{\"${file}\", R\"KILOLUX(${content})KILOLUX\"sv},\n")
endforeach()
string(APPEND text "};\n\n}  // namespace\n\nstd::span<const EmbeddedFile> embedded_files() { return kFiles; }\n\n}  // namespace kilolux\n")
file(WRITE "${OUTPUT}" "${text}")
