#include "protocol/problem.h"

#include <algorithm>
#include <array>

#include "core/text/utf8.h"

namespace strata::protocol {
namespace {

constexpr std::string_view kTypePrefix = "/problems#";

using enum ErrorCode;
constexpr std::array kKinds{
    ProblemKind{malformed, 400, "The request cannot be read.",
                "Correct its syntax, its parameters or its headers."},
    ProblemKind{unauthenticated, 401, "Nobody is signed in, or the secret is not valid.",
                "Sign in, or send a valid token."},
    ProblemKind{forbidden, 403, "This person may not do it.",
                "Ask a curator or an administrator for the role, or do it from the server's page."},
    ProblemKind{not_found, 404, "It does not exist, or this person may not see it.",
                "Check the id or the slug."},
    ProblemKind{method_not_allowed, 405, "The address does not take this method.",
                "Use a method of the header `Allow`."},
    ProblemKind{not_acceptable, 406, "No representation that the client accepts.",
                "Ask for one of the formats that the detail names."},
    ProblemKind{too_slow, 408, "The body of the request comes too slowly.",
                "Send it again over a faster connection."},
    ProblemKind{conflict, 409, "The state of the data does not allow it.",
                "Read the data again and decide; the detail says what is in the way."},
    ProblemKind{superseded, 409, "A newer request took the place of this one.",
                "Use the answer of the newer request."},
    ProblemKind{gone, 410, "The item was deleted in the meantime.",
                "Restore it from the trash, or continue without it."},
    ProblemKind{stale, 412, "Somebody else changed it since it was read.",
                "Read it again, and send the change with its new ETag."},
    ProblemKind{too_large, 413, "More bytes or entries than the server takes.",
                "Send less at once; the detail names the limit."},
    ProblemKind{unsupported, 415, "A format that the server does not read or write.",
                "Convert it to a format that the detail names."},
    ProblemKind{range_not_satisfied, 416, "The file ends before the range of bytes.",
                "Ask for bytes within its length."},
    ProblemKind{misdirected, 421, "The request names a host that the server does not have.",
                "Use an address that the server knows, or start it with `--origin`."},
    ProblemKind{invalid, 422, "A value can be read but is not allowed.",
                "Correct the field that is named."},
    ProblemKind{upgrade_required, 426, "The address speaks WebSocket only.",
                "Connect with the subprotocol strata.v1."},
    ProblemKind{version_required, 428, "The project demands `If-Match`.",
                "Read it again, and send its ETag in `If-Match`."},
    ProblemKind{too_many_requests, 429, "This caller sends more than its share.",
                "Wait as long as `Retry-After` says."},
    ProblemKind{head_too_large, 431, "The head of the request is too long.",
                "Send a shorter address and fewer headers."},
    ProblemKind{cancelled, 499, "The caller took the request back.", "Send it again if need be."},
    ProblemKind{internal, 500, "A mistake in the server, or damaged data.",
                "Report it with the time; the server's log says more."},
    ProblemKind{not_implemented, 501, "A part of HTTP that the server does not have.",
                "Send the request in another form."},
    ProblemKind{bad_gateway, 502, "Another program answered something that is not understood.",
                "Check the address and what is in between."},
    ProblemKind{busy, 503, "Too much work waits.", "Send it again in a moment."},
    ProblemKind{unavailable, 503, "The database or the GPU cannot be reached, or the server stops.",
                "Send it again in a moment; look at /readyz if it stays so."},
    ProblemKind{timed_out, 503, "It takes longer than it may.",
                "Ask about less: a smaller area, a coarser layer, a shorter condition."},
    ProblemKind{gpu_lost, 503, "The graphics context is being restored.",
                "Send it again in a moment."},
    ProblemKind{out_of_memory, 503, "A budget of main or GPU memory is used up.",
                "Close models or layers, send smaller files, or give the server more memory."},
    ProblemKind{storage_full, 507, "The server's disk is full.", "Free space on the server."},
};
static_assert(kKinds.size() == static_cast<std::size_t>(kLastErrorCode) + 1);
static_assert(std::ranges::is_sorted(kKinds, {}, &ProblemKind::code));

constexpr std::size_t kMaxTitle = 200, kMaxDetail = 10'000, kMaxField = 500, kMaxRef = 64,
                      kMaxSuggestion = 500, kMaxSuggestions = 3;
constexpr std::string_view kMore = "…";

std::string bounded(const std::string& text, std::size_t most) {
  if (text.size() <= most) return text;
  return std::string(first_bytes(text, most - kMore.size())).append(kMore);
}

// Leaves out a suggestion that is too long, because only a part of it would be useless.
std::vector<std::string> suggestions_of(const Error& error) {
  std::vector<std::string> suggestions;
  if (!error.offset || error.length == 0) return suggestions;
  for (const std::string& each : error.suggestions)
    if (!each.empty() && each.size() <= kMaxSuggestion && suggestions.size() < kMaxSuggestions)
      suggestions.push_back(each);
  return suggestions;
}

// Returns the detail followed by the suggestions: "… Did you mean wet or dry?"
std::string detail_of(const Error& error) {
  const auto suggestions = suggestions_of(error);
  std::string question;
  for (std::size_t i = 0; i < suggestions.size(); ++i)
    question += (i == 0                        ? " Did you mean "
                 : i + 1 == suggestions.size() ? " or "
                                               : ", ") +
                suggestions[i];
  if (!question.empty()) question += "?";
  return bounded(error.detail + question, kMaxDetail);
}

}  // namespace

std::span<const ProblemKind> problem_kinds() { return kKinds; }

int http_status(ErrorCode code) { return kKinds.at(static_cast<std::size_t>(code)).status; }

std::string problem_type(ErrorCode code) { return std::string(kTypePrefix).append(name(code)); }

std::optional<ErrorCode> code_of_problem_type(std::string_view type) {
  if (!type.starts_with(kTypePrefix)) return std::nullopt;
  return error_code_named(type.substr(kTypePrefix.size()));
}

ErrorCode code_of_http_status(int status) {
  if (status == http_status(unavailable)) return unavailable;
  const auto* kind = std::ranges::find(kKinds, status, &ProblemKind::status);
  if (kind != kKinds.end()) return kind->code;
  return status < 500 ? malformed : internal;
}

ProblemMessage problem_message(const Error& error, const std::optional<std::string>& ref) {
  ProblemMessage message;
  if (ref && !ref->empty()) message.ref = ref->substr(0, kMaxRef);
  message.type = problem_type(error.code);
  message.title = bounded(error.title, kMaxTitle);
  message.status = http_status(error.code);
  message.detail = detail_of(error);
  if (!error.field.empty()) message.field = bounded(error.field, kMaxField);
  if (error.offset) message.offset = static_cast<int>(*error.offset);
  if (error.offset && error.length > 0) message.length = static_cast<int>(error.length);
  if (auto suggestions = suggestions_of(error); !suggestions.empty())
    message.suggestions = std::move(suggestions);
  if (!error.reason.empty()) message.reason = std::string(error.reason);
  return message;
}

nlohmann::json problem_body(const Error& error) {
  nlohmann::json json{{"type", problem_type(error.code)},
                      {"title", bounded(error.title, kMaxTitle)},
                      {"status", http_status(error.code)},
                      {"detail", detail_of(error)}};
  if (!error.field.empty()) json["field"] = bounded(error.field, kMaxField);
  if (error.offset) json["offset"] = *error.offset;
  if (error.offset && error.length > 0) json["length"] = error.length;
  if (auto suggestions = suggestions_of(error); !suggestions.empty())
    json["suggestions"] = std::move(suggestions);
  if (!error.reason.empty()) json["reason"] = error.reason;
  return json;
}

}  // namespace strata::protocol
