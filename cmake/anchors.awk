# For Doxygen, whose versions before 1.10 know no anchors of headings: gives each heading below a page's title the anchor
# that it has on GitHub, with the page's name before it, since Doxygen has one set of anchors for all pages; and leads
# links there. Usage: awk -f anchors.awk PAGE.md
function name_of(path) {
  sub(/\.md$/, "", path)
  sub(/.*\//, "", path)
  return path
}
BEGIN { page = name_of(ARGV[1]) }
/^```/ { in_code = !in_code }
!in_code && !/^    / {
  if (/^##+ /) {
    anchor = tolower($0)
    sub(/^#+ +/, "", anchor)
    gsub(/[^a-z0-9 _-]/, "", anchor)
    gsub(/ /, "-", anchor)
    $0 = $0 " {#" page "-" anchor "}"
  }
  gsub(/\]\(#/, "](#" page "-")
  while (match($0, /\]\([A-Za-z0-9_.\/-]+\.md#/)) {
    $0 = substr($0, 1, RSTART + 1) "#" name_of(substr($0, RSTART + 2, RLENGTH - 3)) "-" substr($0, RSTART + RLENGTH)
  }
}
{ print }
