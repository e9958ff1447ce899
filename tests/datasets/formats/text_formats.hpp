// Every text format with a file of known content.
#pragma once

#include <filesystem>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

namespace corridor::formats::test {

// What a reader made of a text.
struct Outcome {
  bool is_read = false;
  std::size_t num_readings = 0;
  std::string said;  // the Error, or the notes
};

// A text format with a file of known content, and a way to read any text as one.
struct TextFormat {
  std::string name;
  std::string text;
  std::function<Outcome(const std::string& text)> read;
};

// Its name, for GoogleTest.
inline void PrintTo(const TextFormat& format, std::ostream* out) { *out << format.name; }

std::vector<TextFormat> text_formats();

Outcome read_as_log(const std::filesystem::path& path);

// Each with a line's end.
std::string joined(const std::vector<std::string>& lines);

}  // namespace corridor::formats::test
