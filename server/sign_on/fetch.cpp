#include "sign_on/fetch.h"

#include <curl/curl.h>

#include <memory>
#include <mutex>

#include "core/text/url.h"

namespace strata::sign_on {
namespace {

constexpr long kConnect_ms = 5000, kWhole_ms = 10'000;

struct CloseHandle {
  void operator()(CURL* handle) const { curl_easy_cleanup(handle); }
  void operator()(curl_slist* list) const { curl_slist_free_all(list); }
};

size_t collect(char* data, size_t size, size_t count, void* body) {
  auto& text = *static_cast<std::string*>(body);
  if (text.size() + size * count > kMaxReply) return 0;  // curl then ends the transfer
  text.append(data, size * count);
  return size * count;
}

tl::unexpected<Error> unreachable(const std::string& why) {
  return fail(ErrorCode::bad_gateway, "Provider unreachable", why);
}

}  // namespace

Result<HttpReply> fetch(const HttpCall& call) {
  static std::once_flag initialized;
  std::call_once(initialized, [] { curl_global_init(CURL_GLOBAL_DEFAULT); });
  if (!is_safe_url(call.url))
    return unreachable("The address " + call.url.substr(0, 200) + " does not use https.");
  const std::unique_ptr<CURL, CloseHandle> curl(curl_easy_init());
  if (!curl) return unreachable("No memory for the request.");
  std::unique_ptr<curl_slist, CloseHandle> headers(
      curl_slist_append(nullptr, "Accept: application/json"));
  for (const std::string& header : call.headers) curl_slist_append(headers.get(), header.c_str());
  HttpReply reply;
  CURL* const handle = curl.get();
  curl_easy_setopt(handle, CURLOPT_URL, call.url.c_str());
  curl_easy_setopt(handle, CURLOPT_PROTOCOLS_STR, "http,https");
  curl_easy_setopt(handle, CURLOPT_FOLLOWLOCATION, 0L);
  curl_easy_setopt(handle, CURLOPT_NOSIGNAL, 1L);
  curl_easy_setopt(handle, CURLOPT_CONNECTTIMEOUT_MS, kConnect_ms);
  curl_easy_setopt(handle, CURLOPT_TIMEOUT_MS, kWhole_ms);
  curl_easy_setopt(handle, CURLOPT_HTTPHEADER, headers.get());
  curl_easy_setopt(handle, CURLOPT_WRITEFUNCTION, &collect);
  curl_easy_setopt(handle, CURLOPT_WRITEDATA, &reply.body);
  if (is_loopback_url(call.url)) curl_easy_setopt(handle, CURLOPT_PROXY, "");
  if (call.form) {
    curl_easy_setopt(handle, CURLOPT_POSTFIELDSIZE_LARGE,
                     static_cast<curl_off_t>(call.form->size()));
    curl_easy_setopt(handle, CURLOPT_POSTFIELDS, call.form->c_str());
  }
  const CURLcode code = curl_easy_perform(handle);
  if (code == CURLE_WRITE_ERROR) return unreachable("The reply of " + call.url + " is too long.");
  if (code != CURLE_OK) return unreachable(call.url + ": " + curl_easy_strerror(code) + ".");
  curl_easy_getinfo(handle, CURLINFO_RESPONSE_CODE, &reply.status);
  return reply;
}

}  // namespace strata::sign_on
