#include "store/files/s3_files.h"

#include <algorithm>
#include <cstdlib>

#include "core/text/ascii.h"
#include "core/text/percent.h"
#include "core/text/slug.h"
#include "core/text/timestamp.h"
#include "core/text/url.h"

namespace strata::store {
namespace {

constexpr std::size_t kMaxMarkBytes = 4096;
constexpr std::size_t kMaxPage = 4u << 20;  // of 1000 names
constexpr std::size_t kMaxMessage = 300;
constexpr std::string_view kScheme = "s3://";

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

std::string first_of(std::string a, std::string b) {
  return a.empty() ? std::move(b) : std::move(a);
}

bool is_plain(std::string_view text, std::string_view also) {
  return std::ranges::all_of(text, [&](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           also.find(c) != std::string_view::npos;
  });
}

// Returns whether the address is http or https to this machine, or https, without a path.
bool is_safe_endpoint(std::string_view url) {
  return is_safe_url(url) && url.find_first_of("/?", url.find("//") + 2) == std::string_view::npos;
}

// Returns the text between the tags of the first element `name` at or after `at`, and sets `at` to
// the position after the element.
std::optional<std::string_view> element(std::string_view xml, std::string_view name,
                                        std::size_t& at) {
  const std::string open = "<" + std::string(name) + ">", close = "</" + std::string(name) + ">";
  const auto begin = xml.find(open, at);
  if (begin == std::string_view::npos) return std::nullopt;
  const auto text = begin + open.size(), end = xml.find(close, text);
  if (end == std::string_view::npos) return std::nullopt;
  at = end + close.size();
  return xml.substr(text, end - text);
}

std::string_view element(std::string_view xml, std::string_view name) {
  std::size_t at = 0;
  return element(xml, name, at).value_or("");
}

std::string_view text_of_reply(const S3Reply& reply) {
  return {reinterpret_cast<const char*>(reply.body.data()), reply.body.size()};
}

// Returns the error for a refusal of the S3 server, with only printable ASCII from its message.
tl::unexpected<Error> refusal(const std::string& place, const S3Reply& reply) {
  const std::string_view xml = text_of_reply(reply);
  std::string why(element(xml, "Code"));
  if (const auto message = element(xml, "Message"); !message.empty())
    why += ", " + std::string(message);
  std::erase_if(why, [](char c) { return c < ' ' || c > '~'; });
  const ErrorCode code = reply.status == 507 || element(xml, "Code") == "QuotaExceeded"
                             ? ErrorCode::storage_full
                             : ErrorCode::unavailable;
  return fail(code, "Files unavailable",
              "The S3 server refused a request for " + place + " with the status " +
                  std::to_string(reply.status) + (why.empty() ? "" : ": ") +
                  why.substr(0, kMaxMessage) +
                  ". Check the bucket, the keys and their rights (AWS_ACCESS_KEY_ID).",
              "--files");
}

}  // namespace

S3Environment s3_environment() {
  return {variable("AWS_ACCESS_KEY_ID"),
          variable("AWS_SECRET_ACCESS_KEY"),
          variable("AWS_SESSION_TOKEN"),
          first_of(variable("AWS_REGION"), variable("AWS_DEFAULT_REGION")),
          first_of(variable("AWS_ENDPOINT_URL_S3"), variable("AWS_ENDPOINT_URL")),
          variable("AWS_CA_BUNDLE")};
}

Result<S3Place> s3_place(const FilesPlace& place, const S3Environment& environment) {
  const auto wrong = [](const std::string& detail, const char* option) {
    return fail(ErrorCode::malformed, "Invalid place for files", detail, option);
  };
  if (!place.place.starts_with(kScheme))
    return wrong("Enter a folder, or s3://BUCKET/PREFIX.", "--files");
  const std::string_view path = std::string_view(place.place).substr(kScheme.size());
  const auto slash = std::min(path.find('/'), path.size());
  const std::string bucket(path.substr(0, slash));
  std::string prefix(path.substr(std::min(slash + 1, path.size())));
  while (prefix.ends_with('/')) prefix.pop_back();
  if (bucket.size() < 3 || bucket.size() > 63 || !is_plain(bucket, ".-"))
    return wrong("The name of a bucket has 3 to 63 letters, digits, dots and dashes.", "--files");
  if (prefix.size() > 500 || !is_plain(prefix, "._-/") || prefix.starts_with('/') ||
      prefix.find("//") != std::string::npos ||
      ("/" + prefix + "/").find("/../") != std::string::npos ||
      ("/" + prefix + "/").find("/./") != std::string::npos)
    return wrong("A prefix has at most 500 letters, digits, dots, dashes, underscores and slashes.",
                 "--files");
  if (environment.access_key.empty() || environment.secret_key.empty())
    return wrong("Set the keys of the bucket in AWS_ACCESS_KEY_ID and AWS_SECRET_ACCESS_KEY.",
                 "--files");
  const std::string region = first_of(environment.region, "us-east-1");
  if (!is_plain(region, "-"))
    return wrong("AWS_REGION must be a name such as eu-central-1.", "--files");
  std::string endpoint = first_of(place.endpoint, environment.endpoint);
  while (endpoint.ends_with('/')) endpoint.pop_back();
  if (!endpoint.empty() && !is_safe_endpoint(endpoint))
    return wrong(
        "Enter the address of the S3 server as https://HOST:PORT. Only a server on this "
        "machine can use http.",
        "--files-endpoint");
  // The certificates of Amazon do not match the names of buckets with dots.
  std::string url = !endpoint.empty() ? endpoint + "/" + bucket
                    : bucket.find('.') == std::string::npos
                        ? "https://" + bucket + ".s3." + region + ".amazonaws.com"
                        : "https://s3." + region + ".amazonaws.com/" + bucket;
  return S3Place{{std::move(url), region, environment.access_key, environment.secret_key,
                  environment.session_token, environment.ca_file},
                 prefix.empty() ? "" : prefix + "/"};
}

Result<S3Page> read_s3_page(std::string_view xml, std::string_view prefix) {
  const auto wrong = [] {
    return fail(ErrorCode::unavailable, "Files unavailable",
                "The S3 server sent a list that is not valid.", "--files");
  };
  if (xml.find("<ListBucketResult") == std::string_view::npos ||
      xml.find("</ListBucketResult>") == std::string_view::npos)
    return wrong();
  S3Page page;
  page.is_last = element(xml, "IsTruncated") != "true";
  std::size_t at = 0;
  while (const auto contents = element(xml, "Contents", at)) {
    const std::string_view key = element(*contents, "Key");
    if (key.empty()) return wrong();
    page.last_key = key;
    if (!key.starts_with(prefix)) return wrong();
    const auto hash = hash_of_file_name(key.substr(prefix.size()));
    const auto changed = parse_time(element(*contents, "LastModified"));
    const std::string size(element(*contents, "Size"));
    if (!hash) continue;  // such as the mark
    if (!changed || size.empty() || size.size() > 18 || !is_all_digits(size)) return wrong();
    page.files.push_back({*hash, std::stoull(size), *changed});
  }
  if (!page.is_last && page.last_key.empty()) return wrong();
  return page;
}

Result<std::unique_ptr<FileStore>> S3Files::open(const FilesPlace& place,
                                                 const S3Environment& environment, int page_size) {
  auto there = STRATA_TRY(s3_place(place, environment));
  return std::unique_ptr<FileStore>(new S3Files(place.place, std::move(there), page_size));
}

Result<void> S3Files::put_object(const std::string& key, const Content& content,
                                 const std::function<bool()>& cancelled) {
  const auto reply = STRATA_TRY(
      client_.send({.method = S3Call::Method::put, .key = key, .body = &content}, cancelled));
  if (reply.status == 200) return {};
  const auto code = element(text_of_reply(reply), "Code");
  if (code == "XAmzContentSHA256Mismatch" || code == "BadDigest")
    return fail(ErrorCode::conflict, "File changed",
                "The file changed while it was sent. Send it again.", "source_files");
  return refusal(place_, reply);
}

Result<void> S3Files::put(const Content& content, const std::function<bool()>& cancelled) {
  return put_object(key_of(content.hash), content, cancelled);
}

Result<std::vector<std::uint8_t>> S3Files::read(const Sha256& hash, std::uint64_t begin,
                                                std::size_t size) {
  if (size == 0) return std::vector<std::uint8_t>();
  auto reply = STRATA_TRY(
      client_.send({.key = key_of(hash),
                    .range = std::to_string(begin) + "-" + std::to_string(begin + size - 1),
                    .max_reply = std::max<std::size_t>(size, 64u << 10)}));
  if (reply.status == 416) return std::vector<std::uint8_t>();  // after the end of the file
  if (reply.status == 404 && element(text_of_reply(reply), "Code") == "NoSuchKey")
    return fail(ErrorCode::not_found, "File missing",
                "There is no file " + file_name_of(hash) + " in " + place_ + ".");
  // Some servers send the whole file without a range if it is not longer.
  const bool has_bytes = reply.status == 206 || (reply.status == 200 && begin == 0);
  if (!has_bytes) return refusal(place_, reply);
  reply.body.resize(std::min(reply.body.size(), size));
  return std::move(reply.body);
}

Result<bool> S3Files::remove(const Sha256& hash) {
  // The reply to DELETE is the same whether or not the file existed.
  const auto found =
      STRATA_TRY(client_.send({.method = S3Call::Method::head, .key = key_of(hash)}));
  if (found.status != 404) {
    if (found.status != 200) return refusal(place_, found);
    const auto gone =
        STRATA_TRY(client_.send({.method = S3Call::Method::remove, .key = key_of(hash)}));
    if (gone.status != 200 && gone.status != 204 && gone.status != 404)
      return refusal(place_, gone);
  }
  return found.status == 200;
}

Result<void> S3Files::list(const std::function<Result<void>(const StoredFile&)>& visit) {
  for (std::string after;;) {
    std::string query =
        "list-type=2&max-keys=" + std::to_string(page_size_) + "&prefix=" + percent_encode(prefix_);
    if (!after.empty()) query += "&start-after=" + percent_encode(after);
    const auto reply = STRATA_TRY(client_.send({.query = query, .max_reply = kMaxPage}));
    if (reply.status != 200) return refusal(place_, reply);
    const auto page = STRATA_TRY(read_s3_page(text_of_reply(reply), prefix_));
    for (const StoredFile& file : page.files) STRATA_TRY(visit(file));
    if (page.is_last) return {};
    if (page.last_key <= after)
      return fail(ErrorCode::unavailable, "Files unavailable",
                  "The S3 server sent the same part of a list twice.", "--files");
    after = page.last_key;
  }
}

Result<std::optional<std::string>> S3Files::read_mark() {
  const auto reply =
      STRATA_TRY(client_.send({.key = prefix_ + kFilesMark, .max_reply = kMaxMarkBytes}));
  if (reply.status == 404 && element(text_of_reply(reply), "Code") == "NoSuchKey")
    return std::optional<std::string>();
  if (reply.status != 200) return refusal(place_, reply);
  return std::optional(std::string(text_of_reply(reply)));
}

Result<void> S3Files::write_mark(const std::string& text) {
  const Content content =
      content_of(Bytes(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
  return put_object(prefix_ + kFilesMark, content, {});
}

}  // namespace strata::store
