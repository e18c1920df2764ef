# Each class, struct, concept and enumeration of the headers has a comment that says what it is. Those in a namespace
# `detail` are left out, and those within a class, which its own comment is for. Usage: awk -f check_briefs.awk HEADER...
FNR == 1 { detail = documented = 0 }
/^namespace .*detail.* \{/ { detail = 1 }
/^\}.*\/\/ namespace .*detail/ { detail = 0 }
/^\/\/\// { documented = 1; next }
/^(template <.*[>,]|requires .*| .*)$/ { next }  # comes between a comment and its class
/^(class|struct|enum class|concept) [A-Z][A-Za-z0-9_]*[^;<A-Za-z0-9_:]/ && !/;$/ && !detail {  # no specialisation
  ++all
  if (!documented) {
    print FILENAME ":" FNR ": no comment says what this is: " $0
    ++missing
  }
}
{ documented = 0 }
END {
  print all " classes, structs, concepts and enumerations; " missing + 0 " without a comment"
  exit missing > 0 || all < 300
}
