// protocol/frame.md numbers the rules. The web client's tests read the same golden vectors.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <vector>

#include "protocol/frame_header.h"
#include "strata_dirs.h"

namespace strata::protocol {
namespace {

using nlohmann::json;

json golden() {
  std::ifstream file(STRATA_SOURCE_DIR "/protocol/golden/frame_headers.json");
  return json::parse(file);
}

std::vector<std::uint8_t> from_hex(const std::string& hex) {
  std::vector<std::uint8_t> bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
    bytes.push_back(static_cast<std::uint8_t>(std::stoul(hex.substr(i, 2), nullptr, 16)));
  return bytes;
}

FrameHeader header_of(const json& f) {
  FrameHeader h;
  h.codec = f["codec"] == "png" ? FrameCodec::png : FrameCodec::jpeg;
  h.keyframe = f["keyframe"];
  h.still = f["still"];
  h.last = f["last"];
  h.view_id = f["view_id"];
  h.frame = f["frame"];
  h.camera_seq = f["camera_seq"];
  h.scene_sequence = f["scene_sequence"];
  h.x = f["x"];
  h.y = f["y"];
  h.width = f["width"];
  h.height = f["height"];
  h.full_width = f["full_width"];
  h.full_height = f["full_height"];
  h.render_us = f["render_us"];
  h.encode_us = f["encode_us"];
  h.payload_bytes = f["payload_bytes"];
  return h;
}

TEST(FrameHeader, golden_headers_are_read_and_written_byte_for_byte) {
  const json vectors = golden()["valid"];
  ASSERT_GE(vectors.size(), 4u);
  for (const auto& vector : vectors) {
    const auto bytes = from_hex(vector["hex"]);
    const auto header = decode_frame_header(bytes);
    ASSERT_TRUE(header) << vector["name"] << ": " << header.error().field << ": "
                        << header.error().detail;
    EXPECT_EQ(*header, header_of(vector["fields"])) << vector["name"];
    const auto written = encode_frame_header(*header);
    EXPECT_TRUE(std::equal(written.begin(), written.end(), bytes.begin())) << vector["name"];
  }
}

TEST(FrameHeader, every_broken_header_is_refused_with_the_member_it_breaks) {
  const json vectors = golden()["invalid"];
  ASSERT_GE(vectors.size(), 20u);
  for (const auto& vector : vectors) {
    const auto header = decode_frame_header(from_hex(vector["hex"]));
    ASSERT_FALSE(header) << vector["name"];
    EXPECT_EQ(header.error().field, vector["field"]) << vector["name"];
  }
}

TEST(FrameHeader, a_message_cut_anywhere_is_refused) {
  const json vectors = golden()["valid"];
  for (const auto& vector : vectors) {
    const auto bytes = from_hex(vector["hex"]);
    for (std::size_t length = 0; length < bytes.size(); ++length)
      EXPECT_FALSE(decode_frame_header(std::span(bytes).first(length)))
          << vector["name"] << " cut to " << length;
  }
}

}  // namespace
}  // namespace strata::protocol
