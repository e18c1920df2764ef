// A page as a file: the template, the style, the scripts, and the program itself where the build could compile it.
#include "examples/course/page.hpp"
#include "examples/course/program_in_page.hpp"
#include "io/replay_page/three_script.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string_view>

namespace kds::course {

namespace {

constexpr std::string_view page_template =
#include "page_template.inc"
    ;
constexpr std::string_view style =
#include "style.inc"
    ;
constexpr std::string_view scripts[] = {
#include "scripts.inc"
};

void replace(std::string& text, std::string_view mark, std::string_view part) {
  text.replace(text.find(mark), mark.size(), part);
}

/// Files that embed something may be initialised before this one.
std::string& program() {
  static std::string bytes;
  return bytes;
}

}  // namespace

bool embed_program(std::initializer_list<std::string_view> parts) {
  program().clear();
  for (const std::string_view part : parts) program() += part;
  return true;
}

namespace {

std::string base64(std::string_view bytes) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t three = 0;
    for (std::size_t k = i; k < i + 3; ++k) {
      three = three << 8 | (k < bytes.size() ? static_cast<unsigned char>(bytes[k]) : 0u);
    }
    for (int shift = 18; shift >= 0; shift -= 6) text += digits[three >> shift & 63];
  }
  const std::size_t filled = (3 - bytes.size() % 3) % 3;
  return text.replace(text.size() - filled, filled, filled, '=');
}

}  // namespace

std::string embedded_program() { return base64(program()); }

std::string Page::html() const {
  std::string page(page_template);
  std::string code;
  for (const std::string_view script : scripts) code += script;
  // The last mark is replaced first, since inserted text may contain marks.
  replace(page, "/*{SCRIPTS}*/", code);
  std::string three;
  if (view_ == View::space) {
    for (const char* name : {"build/three.min.js", "examples/js/controls/OrbitControls.js"}) {
      // A page without it says that it could not be drawn.
      three += io::three_script(KDS_THREE_FOLDER, name).value_or("") + '\n';
    }
  }
  replace(page, "/*{THREE}*/", three);
  replace(page, "/*{PROGRAM}*/", coefficients_ > 0 ? embedded_program() : "");
  std::string data = json();
  for (std::size_t at = 0; (at = data.find("</", at)) != std::string::npos; ++at) data.replace(at, 2, "<\\/");
  replace(page, "/*{DATA}*/", data);
  replace(page, "/*{STYLE}*/", style);
  replace(page, "/*{PICTURE}*/", base64(picture()));
  return page;
}

void Page::write(int argc, char** argv, const std::string& name) const {
  const std::filesystem::path path = argc > 1 ? argv[1] : name + ".html";
  std::ofstream file(path, std::ios::binary);
  file << html();
  file.close();
  if (!file) throw std::runtime_error("cannot write " + path.string());
  std::cout << "page: " << path.string() << " (open it in a browser)\n";
}

}  // namespace kds::course
