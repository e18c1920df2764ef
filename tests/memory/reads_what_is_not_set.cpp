// A program that ends with a value that nobody has set: valgrind has to tell of it.
#include <memory>

int main() {
  const std::unique_ptr<volatile int[]> values(new volatile int[4]);
  return values[2];
}
