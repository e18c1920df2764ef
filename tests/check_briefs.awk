# Each class, struct, concept and enumeration of the headers has a comment that says what it is: those in a namespace,
# and those that are public members of one. A comment stands before it or at the end of its line. Those in a namespace
# `detail` are left out. Usage: awk -f check_briefs.awk HEADER...
function check(has_comment) {
  ++all
  if (has_comment || /\/\/\/</) return
  print FILENAME ":" FNR ": no comment says what this is: " $0
  ++missing
}
FNR == 1 { detail = documented = member_documented = member = 0 }
/^namespace .*detail.* \{/ { detail = 1 }
/^\}.*\/\/ namespace .*detail/ { detail = 0 }
/^\/\/\// { documented = 1; next }

# Members are indented by two. A line of a template or of a requires-clause comes between a comment and its class.
/^ (public|protected|private):/ { member = /public/ && !detail }
/^  \/\/\// { member_documented = 1; next }
/^  (template <.*|requires .*)$/ { next }
/^  (class|struct|enum class) [A-Z][A-Za-z0-9_]*[^;<A-Za-z0-9_:]/ && /\{|[^;]$/ && member { check(member_documented) }
/^ / { member_documented = 0 }

/^(template <.*[>,]|requires .*| .*)$/ { next }
/^(class|struct|enum class|concept) [A-Z][A-Za-z0-9_]*[^;<A-Za-z0-9_:]/ && !/;$/ && !detail {  # no specialisation
  check(documented)
}
/^(class|struct) / && !/;$/ { member = /^struct/ && !detail }
/^\};/ { member = 0 }
{ documented = 0 }
END {
  print all " classes, structs, concepts and enumerations; " missing + 0 " without a comment"
  exit missing > 0 || all < 400
}
