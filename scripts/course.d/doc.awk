# Renders a page of the documentation as HTML, for the course: headings, paragraphs, lists, tables, code, emphasis, and
# links. A link leads to a page that is rendered beside this one, or to the network; of any other its text is left.
# Usage: awk -v template=doc.html -v rendered="design framework" -f doc.awk PAGE.md
function escaped(text) {
  gsub(/&/, "\\&amp;", text)
  gsub(/</, "\\&lt;", text)
  gsub(/>/, "\\&gt;", text)
  gsub(/"/, "\\&quot;", text)
  return text
}
function link(text, target,   file, anchor) {
  file = target
  sub(/#.*/, "", file)
  anchor = substr(target, length(file) + 1)
  if (file !~ /^https?:/ && file != "") {
    sub(/.*\//, "", file)
    if (!sub(/\.md$/, "", file) || !(file in beside)) return text
    file = file ".html"
  }
  return "<a href=\"" file anchor "\">" text "</a>"
}
# What is between two marks becomes an element; a mark that stands apart is a sign like any other.
function emphasised(text, mark, element,   all, at, rest) {
  all = ""
  while ((at = index(text, mark)) > 0) {
    rest = substr(text, at + length(mark))
    if (substr(text, at - 1, 1) ~ /[A-Za-z0-9)]/ || rest ~ /^[ *]/ || index(rest, mark) < 2) {
      all = all substr(text, 1, at + length(mark) - 1)
      text = rest
      continue
    }
    all = all substr(text, 1, at - 1) "<" element ">" substr(rest, 1, index(rest, mark) - 1) "</" element ">"
    text = substr(rest, index(rest, mark) + length(mark))
  }
  return all text
}
function marked_up(text) { return emphasised(emphasised(text, "**", "b"), "*", "i") }
function inline(text,   all, at, end, name) {
  all = ""
  text = escaped(text)
  while (match(text, /`[^`]+`|\[[^]]+\]\([^)]+\)|\[[^]]+\]/)) {
    at = substr(text, RSTART, RLENGTH)
    all = all "\001" substr(text, 1, RSTART - 1) "\002"
    text = substr(text, RSTART + RLENGTH)
    end = index(at, "](")
    name = substr(at, 2, length(at) - 2)
    if (at ~ /^`/) all = all "<code>" name "</code>"
    else if (end > 0) all = all link(inline_code(substr(at, 2, end - 2)), substr(at, end + 2, length(at) - end - 2))
    else all = all (name in references ? link(inline_code(name), references[name]) : at)
  }
  all = all "\001" text "\002"
  # Emphasis is sought outside code and links only.
  text = ""
  while ((at = index(all, "\001")) > 0) {
    end = index(all, "\002")
    text = text substr(all, 1, at - 1) marked_up(substr(all, at + 1, end - at - 1))
    all = substr(all, end + 1)
  }
  return text all
}
function inline_code(text) {
  while (match(text, /`[^`]+`/)) {
    text = substr(text, 1, RSTART - 1) "<code>" substr(text, RSTART + 1, RLENGTH - 2) "</code>" substr(text, RSTART + RLENGTH)
  }
  return text
}
function put(text) { body = body text "\n" }
function end_paragraph() {
  if (paragraph != "") put(in_item ? inline(paragraph) : "<p>" inline(paragraph) "</p>")
  paragraph = ""
}
function end_lists(depth) {
  end_paragraph()
  while (lists > depth) put("</li></" kind[lists--] ">")
  in_item = lists > 0
}
function end_table() {
  if (in_table) put("</tbody></table></div>")
  in_table = 0
}
function row(text, cell,   cells, count, i, all) {
  gsub(/^\| *| *\| *$/, "", text)
  gsub(/\\\|/, "\003", text)
  count = split(text, cells, / *\| */)
  all = "<tr>"
  for (i = 1; i <= count; ++i) {
    gsub(/\003/, "|", cells[i])
    all = all "<" cell ">" inline(cells[i]) "</" cell ">"
  }
  return all "</tr>"
}
BEGIN {
  count = split(rendered, names, " ")
  for (i = 1; i <= count; ++i) beside[names[i]] = 1
  while ((getline line < ARGV[1]) > 0) {  # [text]: target
    if (line !~ /^\[[^]]+\]: [^ ]+$/) continue
    at = index(line, "]: ")
    references[substr(line, 2, at - 2)] = substr(line, at + 3)
  }
  while ((getline line < template) > 0) page = page line "\n"
}
/^ *```/ && !in_code { end_table(); end_paragraph(); if ($0 ~ /^```/) end_lists(0); put("<pre>"); in_code = 1; next }
/^ *```/ { body = body "</pre>\n"; in_code = 0; next }
in_code { put(escaped($0)); next }
/^\[[^]]+\]: [^ ]+$/ || /^!\[/ || /^<!--.*-->$/ { next }
/^ *$/ { if (in_block) pending = pending "\n"; end_table(); end_paragraph(); blank = 1; next }
in_block && !/^    / { body = body "</pre>\n"; in_block = 0 }
/^    / && (in_block || (blank && lists == 0)) {
  if (!in_block) { put("<pre>"); pending = "" }
  put(pending escaped(substr($0, 5)))
  pending = ""
  in_block = 1
  blank = 0
  next
}
/^#+ / {
  end_lists(0)
  level = index($0, " ") - 1
  heading = substr($0, level + 2)
  if (title == "") title = heading
  anchor = tolower(heading)
  gsub(/[^a-z0-9 _-]/, "", anchor)
  gsub(/ /, "-", anchor)
  put("<h" level " id=\"" anchor "\">" inline(heading) "</h" level ">")
  next
}
/^\|[-| :]+\|$/ { next }
/^\|/ {
  if (!in_table) {
    end_lists(0)
    put("<div class=\"table\"><table><thead>" row($0, "th") "</thead><tbody>")
    in_table = 1
    next
  }
  put(row($0, "td"))
  next
}
match($0, /^ *(-|[0-9]+\.) /) {
  depth = $0 ~ /^ / ? 2 : 1
  if (depth > lists + 1) depth = lists + 1
  end_lists(depth)
  if (lists == depth) put("</li>")
  else {
    kind[++lists] = $0 ~ /^ *-/ ? "ul" : "ol"
    put("<" kind[lists] ">")
  }
  body = body "<li>"
  in_item = 1
  paragraph = substr($0, RSTART + RLENGTH)
  blank = 0
  next
}
{
  if (blank && !/^ /) end_lists(0)
  if (blank && lists > 0) put("<br>")
  sub(/^ +/, "")
  paragraph = paragraph (paragraph == "" ? "" : " ") $0
  blank = 0
}
END {
  if (in_block) put("</pre>")
  end_table()
  end_lists(0)
  at = index(page, "<!--{TEXT}-->")
  page = substr(page, 1, at - 1) body substr(page, at + 13)
  at = index(page, "<!--{TITLE}-->")
  printf "%s", substr(page, 1, at - 1) escaped(title) substr(page, at + 14)
}
