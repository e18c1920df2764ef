# -DWASM=FILE: writes FILE.cpp, which embeds the file, compressed, in the pages of a program that is linked with it.
file(ARCHIVE_CREATE OUTPUT "${WASM}.gz" PATHS "${WASM}" FORMAT raw COMPRESSION GZip COMPRESSION_LEVEL 9)
file(READ "${WASM}.gz" bytes HEX)
# The time of the compression, in the second four bytes, would make a page differ from build to build.
string(SUBSTRING "${bytes}" 0 8 magic)
string(SUBSTRING "${bytes}" 16 -1 rest)
set(bytes "${magic}00000000${rest}")
string(LENGTH "${bytes}" digits)
# Compilers need not take strings of more than 65536 characters.
set(part 60000)
set(parts "")
foreach(at RANGE 0 ${digits} ${part})
  string(SUBSTRING "${bytes}" ${at} ${part} piece)
  string(LENGTH "${piece}" length)
  math(EXPR length "${length} / 2")
  string(REGEX REPLACE "(..)" "\\\\x\\1" piece "${piece}")
  string(APPEND parts "    {\"${piece}\", ${length}},\n")
endforeach()
file(WRITE "${WASM}.cpp" "#include \"examples/course/program_in_page.hpp\"
namespace {
[[maybe_unused]] const bool embedded = kds::course::embed_program({
${parts}});
}
")
