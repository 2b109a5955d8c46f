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
    ProblemKind{unauthenticated, 401, "The request has no valid session or token.",
                "Sign in, or send a valid token."},
    ProblemKind{forbidden, 403, "The user has no right to do this.",
                "Ask a curator or an administrator for the role, or use the server's own page."},
    ProblemKind{not_found, 404, "The item does not exist, or the user cannot see it.",
                "Check the id or the slug."},
    ProblemKind{method_not_allowed, 405, "The address does not support this method.",
                "Use a method that the header `Allow` lists."},
    ProblemKind{not_acceptable, 406,
                "The server cannot respond in a format that the client accepts.",
                "Accept one of the formats that the detail names."},
    ProblemKind{too_slow, 408, "The body of the request arrives too slowly.",
                "Send the request again over a faster connection."},
    ProblemKind{conflict, 409, "The state of the data does not allow the request.",
                "Read the data again. The detail names the conflict."},
    ProblemKind{superseded, 409, "A newer request replaced this one.",
                "Use the response to the newer request."},
    ProblemKind{gone, 410, "The item was deleted, or the state was removed from the history.",
                "Restore the item from the Trash, or request a state that the error names."},
    ProblemKind{stale, 412, "Another user changed the item after it was read.",
                "Read the item again, and send the change with its new ETag."},
    ProblemKind{too_large, 413, "The request exceeds a size limit.",
                "Send fewer bytes or entries. The detail names the limit."},
    ProblemKind{unsupported, 415, "The server does not support the format.",
                "Convert the data to a format that the detail names."},
    ProblemKind{range_not_satisfied, 416, "The range of bytes begins after the end of the file.",
                "Request bytes within the length of the file."},
    ProblemKind{misdirected, 421, "The request names a host that the server does not serve.",
                "Use an address of the server, or start the server with `--origin`."},
    ProblemKind{invalid, 422, "A value has the right form but is not allowed.",
                "Correct the field that the error names."},
    ProblemKind{upgrade_required, 426, "The address supports only WebSocket.",
                "Connect with the subprotocol `strata.v1`."},
    ProblemKind{version_required, 428, "The project requires the header `If-Match`.",
                "Read the item, and send its ETag in `If-Match`."},
    ProblemKind{too_many_requests, 429, "The client exceeds its limit of requests.",
                "Wait for the seconds in the header `Retry-After`."},
    ProblemKind{head_too_large, 431, "The request line and the headers are too long.",
                "Send a shorter address and fewer headers."},
    ProblemKind{cancelled, 499, "The client canceled the request.",
                "Send the request again if you need the response."},
    ProblemKind{moved, 307, "Another node of the site has the model.",
                "Send the same request to the address in the header `Location`."},
    ProblemKind{internal, 500, "The server has a fault, or stored data is damaged.",
                "Report the error with its time. The server's log has the details."},
    ProblemKind{damaged, 500, "A stored file is missing, or its content has changed.",
                "Inform an administrator. `strata files check` lists the files."},
    ProblemKind{not_implemented, 501, "The server does not support this part of HTTP.",
                "Send the request in a different form."},
    ProblemKind{bad_gateway, 502, "Another program sent an invalid response.",
                "Check the address, and the proxies in front of the server."},
    ProblemKind{busy, 503, "The server is overloaded.",
                "Send the request again after a few seconds."},
    ProblemKind{
        unavailable, 503, "The database or the GPU is not available, or the server is stopping.",
        "Send the request again after a few seconds. If the error remains, read `/readyz`."},
    ProblemKind{timed_out, 503, "The request exceeded its time limit.",
                "Use a smaller area, a coarser layer or a shorter condition."},
    ProblemKind{gpu_lost, 503, "The server is restoring the graphics context.",
                "Send the request again after a few seconds."},
    ProblemKind{
        out_of_memory, 503, "A limit of main memory or GPU memory is reached.",
        "Close models or layers, send smaller files, or increase the server's memory limits."},
    ProblemKind{storage_full, 507, "The server's disk is full.", "Free disk space on the server."},
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
