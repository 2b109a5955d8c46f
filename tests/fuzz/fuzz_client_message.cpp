// Feeds arbitrary bytes to everything that reads the wire: text messages, HTTP bodies and frame headers. Besides
// crashes it finds values that are read but not written back the same.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "protocol/frame_header.h"
#include "protocol/parse.h"

namespace {

using namespace strata::protocol;

void demand(bool holds) {
  if (!holds) std::abort();
}

void read_client_message(std::string_view text) {
  std::string ref;
  const auto message = parse_client_message(text, &ref);
  demand(ref.size() <= 64);
  if (!message) {
    demand(message.error().status >= 400 && !message.error().title.empty());
    return;
  }
  const auto again = parse_client_message(to_text(*message));
  demand(again.has_value() && *again == *message);
}

template <class Body>
void read_body(const nlohmann::json& json) {
  const auto body = from_json<Body>(json);
  if (!body) return;
  const auto again = from_json<Body>(to_json(*body));
  demand(again.has_value() && *again == *body);
}

void read_frame(std::span<const std::uint8_t> bytes) {
  const auto header = decode_frame_header(bytes);
  if (!header) return;
  const auto written = encode_frame_header(*header);
  demand(std::equal(written.begin(), written.end(), bytes.begin()));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  read_frame({data, size});
  read_client_message(text);
  if (const auto json = parse_json(text)) {
    read_body<Edit>(*json);
    read_body<LayerCreate>(*json);
    read_body<LayerPatch>(*json);
    read_body<ModelPatch>(*json);
    read_body<ProjectCreate>(*json);
    read_body<FrameRequest>(*json);
    read_body<PositionsRequest>(*json);
    (void)parse_server_message(text);
  }
  return 0;
}
