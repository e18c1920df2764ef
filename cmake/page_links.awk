# Links of HTML pages lead to files that are there and to places that are in them. Usage: awk -f page_links.awk
# PAGE.html...; files that are linked to and are no pages need not be named.
function folder_of(path) { return match(path, /.*\//) ? substr(path, 1, RLENGTH) : "" }
function whole(path) {
  while (match(path, /[^\/]+\/\.\.\//)) path = substr(path, 1, RSTART - 1) substr(path, RSTART + RLENGTH)
  while (sub(/\/\.\//, "/", path)) {}
  return path
}
function exists(path,   line, read) {
  if (path in pages) return 1
  if (!(path in seen)) {
    read = (getline line < path)
    seen[path] = read >= 0
    close(path)
  }
  return seen[path]
}
FNR == 1 { pages[FILENAME] = 1; ++count; script = 0 }
/<script/ { script = 1 }
script { if (/<\/script>/) script = 0; else next }
{
  rest = $0
  while (match(rest, / (href|src|id|name)="[^"]*"/)) {
    name = substr(rest, RSTART + 1, index(substr(rest, RSTART), "=") - 2)
    value = substr(rest, RSTART, RLENGTH - 1)
    sub(/^[^"]*"/, "", value)
    rest = substr(rest, RSTART + RLENGTH)
    if (name == "id" || name == "name") places[FILENAME "#" value] = 1
    else if (value !~ /^(data:|https?:|mailto:|javascript:)/) links[FILENAME, value] = FILENAME "\n" value
  }
}
END {
  for (link in links) {
    split(links[link], parts, "\n")
    ++all
    target = parts[2]
    gsub(/%20/, " ", target)
    place = ""
    if ((at = index(target, "#")) > 0) {
      place = substr(target, at)
      target = substr(target, 1, at - 1)
    }
    sub(/\?.*/, "", target)
    path = target == "" ? parts[1] : whole(folder_of(parts[1]) target)
    wrong = !exists(path) || (place != "" && place != "#" && path in pages && !(path place in places))
    if (wrong) {
      print parts[1] ": leads to " parts[2] ", which is not there"
      ++dead
    }
  }
  if (count < least) print "only " count " pages"
  print all + 0 " links of " count " pages; " dead + 0 " lead nowhere"
  exit dead > 0 || count < least
}
