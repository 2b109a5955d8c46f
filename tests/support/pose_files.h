#pragma once

#include <string>
#include <vector>

#include "core/text/bytes.h"
#include "media/photographs/posed_photographs.h"

namespace strata::test {

// A file of an export of cameras.
struct NamedText {
  std::string name, content;
};

inline Result<photo::PosedPhotographs> read_pose_texts(const std::vector<NamedText>& files) {
  std::vector<photo::PoseFile> given;
  for (const auto& [name, content] : files) given.push_back({name, bytes_of(content)});
  return photo::read_poses(given);
}

}  // namespace strata::test
