// Runs a harness on files, on mutations of them and on random bytes: fuzzing where there is no libFuzzer.
//
// fuzz_NAME [--runs N] [--seed FIRST] [FILE or FOLDER]...
//
// All files first, then N inputs from the seeds FIRST, FIRST + 1 ... (default 1). The environment variable
// KDS_FUZZ_RUNS, if set, is instead of --runs. A failure, whatever its kind, is reported with its file or seed, and the
// program exits with 1, or as crashes do; `--runs 1 --seed S` with the same files makes the input again. What has
// failed without a crash is written to the file `failed-input`. A file that cannot be read is refused with 2.
#include "tests/fuzz/check.hpp"
#include "tests/support/random_numbers.hpp"

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// Set in sanitized programs alone.
extern "C" void __sanitizer_set_death_callback(void (*)()) __attribute__((weak));

namespace {

using Input = std::vector<std::uint8_t>;

/// What is being run, for whoever reports a crash.
char now_running[512];

void say_what_was_running() { std::fprintf(stderr, "failed on %s\n", now_running); }

extern "C" void crashed(int signal) {
  say_what_was_running();
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

bool passes(const std::string& name, const Input& input) {
  std::snprintf(now_running, sizeof now_running, "%s", name.c_str());
  try {
    kds::fuzz::run(input);
    return true;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", name.c_str(), error.what());
    std::ofstream("failed-input", std::ios::binary).write(reinterpret_cast<const char*>(input.data()),
                                                         static_cast<std::streamsize>(input.size()));
    return false;
  }
}

Input read(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return Input(std::istreambuf_iterator<char>(in), {});
}

void mutate(kds::tests::Random& random, const std::vector<Input>& examples, Input& input) {
  const auto place = [&](const Input& where) {
    return where.begin() + static_cast<std::ptrdiff_t>(random.below(where.size() + 1));
  };
  const auto part = [&](const Input& where) {
    const auto begin = place(where);
    return std::pair(begin, begin + std::min<std::ptrdiff_t>(random.integer(1, 32), where.end() - begin));
  };
  switch (random.below(5)) {
    case 0:
      if (!input.empty()) input[random.below(input.size())] = static_cast<std::uint8_t>(random.bits());
      break;
    case 1:
      if (!input.empty()) input[random.below(input.size())] ^= static_cast<std::uint8_t>(1 << random.below(8));
      break;
    case 2: {
      const auto [begin, end] = part(input);
      input.erase(begin, end);
      break;
    }
    case 3: {
      const auto [begin, end] = part(input);
      const Input copy(begin, end);
      input.insert(place(input), copy.begin(), copy.end());
      break;
    }
    default: {
      const Input& other = examples[random.below(examples.size())];
      const auto [begin, end] = part(other);
      input.insert(place(input), begin, end);
    }
  }
}

Input make(std::uint64_t seed, const std::vector<Input>& examples) {
  kds::tests::Random random(seed);
  if (!examples.empty() && random.below(8) < 6) {
    Input input = examples[random.below(examples.size())];
    for (int i = random.integer(1, 6); i > 0; --i) mutate(random, examples, input);
    return input;
  }
  Input input(static_cast<std::size_t>(1) << random.integer(3, 10));
  // Small bytes are as likely as large ones: they are counts and choices.
  const std::uint64_t mask = random.one_in(2) ? 0xff : 0x1f;
  for (auto& byte : input) byte = static_cast<std::uint8_t>(random.bits() & mask);
  return input;
}

std::vector<std::filesystem::path> files_of(const std::filesystem::path& path) {
  if (!std::filesystem::is_directory(path)) return {path};
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(path)) {
    if (entry.is_regular_file()) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());  // so that a seed means the same everywhere
  return files;
}

}  // namespace

int main(int argc, char** argv) {
  std::uint64_t runs = 0;
  std::uint64_t first = 1;
  std::vector<std::filesystem::path> files;
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument = argv[i];
    if ((argument == "--runs" || argument == "--seed") && i + 1 < argc) {
      (argument == "--runs" ? runs : first) = std::strtoull(argv[++i], nullptr, 10);
    } else {
      for (const auto& file : files_of(argument)) {
        if (!std::ifstream(file)) {
          std::fprintf(stderr, "%s cannot be read\n", file.c_str());
          return 2;
        }
        files.push_back(file);
      }
    }
  }
  if (const char* wished = std::getenv("KDS_FUZZ_RUNS")) runs = std::strtoull(wished, nullptr, 10);

  for (const int signal : {SIGABRT, SIGFPE, SIGILL}) std::signal(signal, crashed);
  if (__sanitizer_set_death_callback) {
    __sanitizer_set_death_callback(say_what_was_running);
  } else {
    std::signal(SIGSEGV, crashed);
  }
  std::uint64_t failures = 0;
  std::vector<Input> examples;
  for (const auto& file : files) {
    examples.push_back(read(file));
    failures += !passes(file.string(), examples.back());
  }
  for (std::uint64_t seed = first; seed < first + runs && failures < 10; ++seed) {
    failures += !passes("seed " + std::to_string(seed), make(seed, examples));
  }
  std::printf("%zu files, seeds %llu to %llu: %llu failures\n", files.size(), static_cast<unsigned long long>(first),
              static_cast<unsigned long long>(first + runs - 1), static_cast<unsigned long long>(failures));
  return failures == 0 ? 0 : 1;
}
