// The structure of an MRPT rawlog, checked byte by byte before MRPT sees it: MRPT takes a truncated
// file for a shorter one, a flipped bit for data and a corrupted length for gigabytes to allocate.
// Every object is walked by the layout of its class and version: length of the class name, allowed
// names, versions, counts within caps, the end flag 0x88. Values are not judged here.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "slam/core/result.hpp"

namespace corridor::formats {

// One top-level object of the file.
struct RawlogFrame {
  std::string_view class_name;  // without its namespace: "CObservation2DRangeScan"
  std::size_t begin = 0;        // byte offset in the decompressed file
  std::size_t size = 0;
};

// `bytes` is the decompressed file; the frames look into it. The Error names the byte and what the
// layout asks for there.
Result<std::vector<RawlogFrame>> check_rawlog_frames(std::string_view bytes,
                                                     const std::string& file);

}  // namespace corridor::formats
