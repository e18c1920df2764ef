# For Doxygen, whose versions before 1.10 know no anchors of headings: gives each heading below a page's title the anchor
# that it has on GitHub, with the page's name before it, since Doxygen has one set of anchors for all pages; and leads
# links there. Links to sources become references to their pages. Usage: awk -f anchors.awk PAGE.md
function name_of(path) {
  sub(/\.md$/, "", path)
  sub(/.*\//, "", path)
  return path
}
function reference(source, text) {
  gsub(/`/, "", text)
  sub(/^(\.\.\/)*/, "", source)
  return "@ref " source " \"" text "\""
}
BEGIN {
  page = name_of(ARGV[1])
  while ((getline line < ARGV[1]) > 0) {  # [text]: source
    if (line !~ /^\[[^]]+\]: .*\.[ch]pp$/) continue
    text = substr(line, 2, index(line, "]") - 2)
    sources[text] = substr(line, index(line, "]") + 3)
  }
}
/^```/ { in_code = !in_code }
!in_code && !/^    / {
  if (/^##+ /) {
    anchor = tolower($0)
    sub(/^#+ +/, "", anchor)
    gsub(/[^a-z0-9 _-]/, "", anchor)
    gsub(/ /, "-", anchor)
    $0 = $0 " {#" page "-" anchor "}"
  }
  # Doxygen finds pictures by their names, and copies them beside its pages.
  while (match($0, /!\[[^]]*\]\([^)]*\//)) {
    link = substr($0, RSTART, RLENGTH)
    sub(/\].*/, "](", link)
    $0 = substr($0, 1, RSTART - 1) link substr($0, RSTART + RLENGTH)
  }
  gsub(/\]\(#/, "](#" page "-")
  while (match($0, /\]\([A-Za-z0-9_.\/-]+\.md#/)) {
    $0 = substr($0, 1, RSTART + 1) "#" name_of(substr($0, RSTART + 2, RLENGTH - 3)) "-" substr($0, RSTART + RLENGTH)
  }
  while (match($0, /\[[^]]*\]\([A-Za-z0-9_.\/-]+\.[ch]pp\)/)) {
    link = substr($0, RSTART + 1, RLENGTH - 2)
    at = index(link, "](")
    $0 = substr($0, 1, RSTART - 1) reference(substr(link, at + 2), substr(link, 1, at - 1)) substr($0, RSTART + RLENGTH)
  }
  for (text in sources) {
    at = index($0, "[" text "]")
    if (at == 1) $0 = ""
    if (at > 1) $0 = substr($0, 1, at - 1) reference(sources[text], text) substr($0, at + length(text) + 2)
  }
}
{ print }
