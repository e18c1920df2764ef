// Debian's C++ library for WebAssembly has no exceptions: whatever is thrown ends the program. The page goes on with
// the run that it has, and says so.
#include <cstddef>

extern "C" {
void* __cxa_allocate_exception(std::size_t /*size*/) { __builtin_trap(); }
void __cxa_throw(void* /*thrown*/, void* /*type*/, void (*)(void*) /*destroy*/) { __builtin_trap(); }
}
