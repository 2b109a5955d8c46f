// Fuzzes all readers of the wire format with arbitrary bytes: text messages, HTTP bodies and frame
// headers. In addition to crashes, it detects values that change when they are read and written
// back.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string>
#include <string_view>

#include "protocol/fast_json.h"
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
    demand(!is_server_failure(message.error().code) && !message.error().title.empty());
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

template <class... Bodies>
void read_bodies(const nlohmann::json& json) {
  (read_body<Bodies>(json), ...);
}

void read_frame(std::span<const std::uint8_t> bytes) {
  const auto header = decode_frame_header(bytes);
  if (!header) return;
  const auto written = encode_frame_header(*header);
  demand(std::equal(written.begin(), written.end(), bytes.begin()));
}

// Returns the message of a fixture, so the fixtures of protocol/ are seeds without changes. A
// fixture is {"schema": …, "json": the message} or {…, "text": the message}.
std::string unwrap_fixture(std::string_view text) {
  const auto json = parse_json(text);
  if (!json || !json->is_object() || !json->contains("schema")) return std::string(text);
  if (auto body = json->find("json"); body != json->end()) return body->dump();
  if (auto body = json->find("text"); body != json->end() && body->is_string())
    return body->get<std::string>();
  return std::string(text);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  read_frame({data, size});
  const std::string text = unwrap_fixture({reinterpret_cast<const char*>(data), size});
  read_client_message(text);
  if (const auto fast = read_json_fast(text, JsonLimits{}.max_depth))
    demand(*fast == nlohmann::json::parse(text));
  if (const auto json = parse_json(text)) {
    read_bodies<AttachmentMatch, AttachmentPatch, ColumnCreate, ColumnPatch, CommentCreate,
                CommentPatch, CrossTableRequest, DifferenceRequest, Edit, Empty, FigureRequest,
                FrameRequest, GroupCreate, GroupPatch, Highlight, InvitationAccept, InvitationShow,
                KioskCreate, KioskLogin, KioskPatch, LayerCreate, LayerPatch, LogLevels, Login,
                LookPatch, MePatch, MemberPut, ModelPatch, PasswordChange, PersonCreate,
                PersonPatch, PersonalView, PickRequest, PositionsRequest, ProfileRequest,
                ProjectCreate, ProjectPatch, RecordPatch, RecordsCreate, ReplyCreate, Restore,
                ScriptTokenCreate, SectionRequest, SelectRequest, SnapshotCreate, SnapshotPatch,
                TableCreate, TablePatch, Template, TemplateUse, ToolPatch, TourCreate, TourPatch,
                Transfer, ViewCreate, ViewPatch>(*json);
    // has no member for its constant `all`, so it cannot be written again
    (void)from_json<Review>(*json);
    (void)parse_server_message(text);
  }
  return 0;
}
