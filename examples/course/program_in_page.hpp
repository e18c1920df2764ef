// The program of a page in the page itself, compiled to WebAssembly, so that it can be run anew in a browser.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

namespace kds::course {

/// Every page that this program writes has it from then on: a WebAssembly module, compressed by gzip, in parts that
/// follow one another. For the files that the build generates (browser/embed.cmake). Gives true.
bool embed_program(std::initializer_list<std::string_view> parts);

/// What has been embedded, in base64; empty if nothing has.
std::string embedded_program();

}  // namespace kds::course
