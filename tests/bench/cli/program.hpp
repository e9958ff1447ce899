// Starts the program under test as a user would and keeps what it said.
#pragma once

#include <gtest/gtest.h>
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

// One line on stderr with these parts, exit code 2, and nothing left in the folder.
inline void expect_refused(const ScratchFolder& folder, const std::string& arguments,
                           const std::vector<std::string>& parts) {
  const std::vector<std::string> before = contents_of(folder.path());
  const Answer answer = run_program(folder, arguments);
  EXPECT_EQ(answer.exit_code, 2) << arguments;
  EXPECT_EQ(answer.num_error_lines(), 1) << answer.err;
  EXPECT_EQ(answer.out, "") << arguments;
  for (const std::string& part : parts) {
    EXPECT_NE(answer.err.find(part), std::string::npos) << part << " in " << answer.err;
  }
  EXPECT_EQ(contents_of(folder.path()), before) << arguments;
}

}  // namespace corridor::testing
