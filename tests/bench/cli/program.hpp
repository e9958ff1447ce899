// Starts the program under test as a user would and keeps what it said.
#pragma once

#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "tests/support/scratch_folder.hpp"

namespace corridor::testing {

struct Answer {
  int exit_code = -1;
  std::string out;
  std::string err;

  [[nodiscard]] std::ptrdiff_t num_error_lines() const {
    return std::count(err.begin(), err.end(), '\n');
  }
};

inline std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

// Runs in `folder`; `arguments` are words of a shell command line, before which `first` is done.
inline Answer run_program(const ScratchFolder& folder, const std::string& arguments,
                          const std::string& first = "") {
  const ScratchFolder said;
  const std::string command = first + "cd '" + folder.path().string() +
                              "' && '" CORRIDOR_BINARY_DIR "/bin/corridor-bench' " + arguments +
                              " >'" + (said / "out").string() + "' 2>'" + (said / "err").string() +
                              "' </dev/null";
  const int status = std::system(command.c_str());
  Answer answer;
  answer.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  answer.out = text_of(said / "out");
  answer.err = text_of(said / "err");
  return answer;
}

// Paths below a folder, relative to it, sorted.
inline std::vector<std::string> contents_of(const std::filesystem::path& folder) {
  std::vector<std::string> paths;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    paths.push_back(std::filesystem::relative(entry.path(), folder).string());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

}  // namespace corridor::testing
