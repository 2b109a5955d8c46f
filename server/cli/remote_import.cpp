#include "cli/remote_import.h"

#include <curl/curl.h>

#include <chrono>
#include <cstdio>
#include <cstring>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "protocol/problem.h"

namespace strata::cli {
namespace {

struct Reply {
  long status = 0;
  std::string body;
};

tl::unexpected<Error> not_strata(const std::string& what) {
  return fail(
      ErrorCode::bad_gateway, "Not a Strata server",
      what +
          " is not a valid response of a Strata server. Check the address, and check whether a "
          "proxy changes the responses.");
}

// Returns the JSON object in a reply. Checks that it has these members.
Result<nlohmann::json> object_in(const Reply& reply, std::initializer_list<const char*> members) {
  auto json = nlohmann::json::parse(reply.body, nullptr, false);
  if (!json.is_object()) return not_strata("The answer");
  for (const char* member : members)
    if (!json.contains(member))
      return not_strata(std::string("A response without `") + member + "`");
  return json;
}

std::string text_of(const nlohmann::json& object, const char* member) {
  if (!object.is_object()) return {};
  const auto found = object.find(member);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

// Returns the server's problem. Replaces missing members by the HTTP status and the given texts.
Error problem_of(const nlohmann::json& json, int status, const std::string& title,
                 const std::string& detail) {
  const auto code = protocol::code_of_problem_type(text_of(json, "type"));
  Error problem{code.value_or(protocol::code_of_http_status(status)), text_of(json, "title"),
                text_of(json, "detail"), text_of(json, "field")};
  if (problem.title.empty()) problem.title = title;
  if (problem.detail.empty()) problem.detail = detail;
  return problem;
}

size_t collect(char* data, size_t size, size_t count, void* body) {
  static_cast<std::string*>(body)->append(data, size * count);
  return size * count;
}

// Returns whether the server runs on this machine. The certificate of a local server names a
// different host. It need not be checked, because there is no network in between.
bool is_this_machine(const std::string& base) {
  for (const char* host : {"https://127.0.0.1", "https://localhost", "https://[::1]"})
    if (base.starts_with(host)) {
      const std::string_view rest = std::string_view(base).substr(std::strlen(host));
      return rest.empty() || rest.front() == ':' || rest.front() == '/';
    }
  return false;
}

class Client {
 public:
  Client(std::string base, const std::string& token) : base_(std::move(base)) {
    curl_.reset(curl_easy_init());
    while (!base_.empty() && base_.back() == '/') base_.pop_back();
    headers_.reset(curl_slist_append(nullptr, ("Authorization: Bearer " + token).c_str()));
    curl_slist_append(headers_.get(), "Content-Type: application/octet-stream");
    curl_slist_append(headers_.get(), "Expect:");
    // No Content-Type here, because curl sets it.
    form_headers_.reset(curl_slist_append(nullptr, ("Authorization: Bearer " + token).c_str()));
    curl_slist_append(form_headers_.get(), "Expect:");
  }

  Result<Reply> get(const std::string& path) {
    curl_easy_reset(curl_.get());
    return perform(path, headers_.get());
  }

  // Streams a single file as the body, or several files as a form. Reports the uploaded fraction.
  Result<Reply> post_files(const std::string& path, const std::vector<jobs::ImportFile>& files,
                           Progress& progress) {
    curl_easy_reset(curl_.get());
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> in{nullptr, &std::fclose};
    std::unique_ptr<curl_mime, void (*)(curl_mime*)> form{nullptr, &curl_mime_free};
    if (files.size() == 1) {
      in.reset(std::fopen(files[0].path.c_str(), "rb"));
      if (!in) return fail(ErrorCode::malformed, "File cannot be read", files[0].path.string());
      curl_easy_setopt(curl_.get(), CURLOPT_POST, 1L);
      curl_easy_setopt(curl_.get(), CURLOPT_READDATA, in.get());
      curl_easy_setopt(curl_.get(), CURLOPT_POSTFIELDSIZE_LARGE,
                       static_cast<curl_off_t>(std::filesystem::file_size(files[0].path)));
    } else {
      form.reset(curl_mime_init(curl_.get()));
      for (const jobs::ImportFile& file : files) {
        curl_mimepart* part = curl_mime_addpart(form.get());
        curl_mime_name(part, "files");
        if (curl_mime_filedata(part, file.path.c_str()) != CURLE_OK)
          return fail(ErrorCode::malformed, "File cannot be read", file.path.string());
        curl_mime_filename(part, file.filename.c_str());
      }
      curl_easy_setopt(curl_.get(), CURLOPT_MIMEPOST, form.get());
    }
    curl_easy_setopt(curl_.get(), CURLOPT_NOPROGRESS, 0L);
    curl_easy_setopt(curl_.get(), CURLOPT_XFERINFODATA, &progress);
    curl_easy_setopt(
        curl_.get(), CURLOPT_XFERINFOFUNCTION,
        +[](void* p, curl_off_t, curl_off_t, curl_off_t total, curl_off_t now) {
          auto& watched = *static_cast<Progress*>(p);
          if (total > 0) watched.report(double(now) / double(total), "Sending the files");
          return watched.cancelled() ? 1 : 0;
        });
    return perform(path, form ? form_headers_.get() : headers_.get());
  }

  std::string escape(const std::string& text) {
    std::unique_ptr<char, void (*)(void*)> out(
        curl_easy_escape(curl_.get(), text.c_str(), static_cast<int>(text.size())), &curl_free);
    return out.get();
  }

 private:
  Result<Reply> perform(const std::string& path, curl_slist* headers) {
    Reply reply;
    curl_easy_setopt(curl_.get(), CURLOPT_URL, (base_ + path).c_str());
    curl_easy_setopt(curl_.get(), CURLOPT_HTTPHEADER, headers);
    if (is_this_machine(base_)) {
      curl_easy_setopt(curl_.get(), CURLOPT_SSL_VERIFYHOST, 0L);
      curl_easy_setopt(curl_.get(), CURLOPT_SSL_VERIFYPEER, 0L);
    }
    curl_easy_setopt(curl_.get(), CURLOPT_WRITEFUNCTION, &collect);
    curl_easy_setopt(curl_.get(), CURLOPT_WRITEDATA, &reply.body);
    const CURLcode code = curl_easy_perform(curl_.get());
    if (code != CURLE_OK)
      return fail(ErrorCode::unavailable, "Server not reachable",
                  base_ + ": " + curl_easy_strerror(code));
    curl_easy_getinfo(curl_.get(), CURLINFO_RESPONSE_CODE, &reply.status);
    if (reply.status >= 400) {
      return tl::unexpected(problem_of(
          nlohmann::json::parse(reply.body, nullptr, false), static_cast<int>(reply.status),
          "Refused", "The server answered " + std::to_string(reply.status) + "."));
    }
    return reply;
  }

  std::string base_;
  std::unique_ptr<CURL, void (*)(CURL*)> curl_{nullptr, &curl_easy_cleanup};
  std::unique_ptr<curl_slist, void (*)(curl_slist*)> headers_{nullptr, &curl_slist_free_all};
  std::unique_ptr<curl_slist, void (*)(curl_slist*)> form_headers_{nullptr, &curl_slist_free_all};
};

std::string import_path(Client& client, const jobs::ImportRequest& request) {
  std::string path = "/api/v1/models?filename=" + client.escape(request.files[0].filename);
  auto add = [&](const char* name, const std::string& value) {
    if (!value.empty()) path += std::string("&") + name + "=" + client.escape(value);
  };
  add("name", request.name);
  add("project", request.project);
  if (request.unit) add("unit", std::string(name(*request.unit)));
  add("up", request.up);
  add("crs", request.crs);
  add("object", request.object);
  add("survey_date", request.survey_date);
  if (request.resolution) add("resolution", std::to_string(request.resolution));
  const auto add_length = [&](const char* name, double length) {
    if (length > 0) add(name, (std::ostringstream() << length).str());
  };
  add_length("weld", request.weld_distance);
  add_length("cell", request.cell);
  add_length("gap", request.gap);
  if (request.parts) add("parts", "true");
  if (request.strict) add("strict", "true");
  return path;
}

}  // namespace

Result<std::string> import_remotely(const std::string& server_url, const std::string& token,
                                    const jobs::ImportRequest& request, Progress& progress) {
  Client client(server_url, token);
  auto posted =
      STRATA_TRY(client.post_files(import_path(client, request), request.files, progress));
  const auto accepted = STRATA_TRY(object_in(posted, {"id"}));
  const std::string job_path = "/api/v1/jobs/" + accepted.at("id").dump();
  while (true) {
    auto polled = STRATA_TRY(client.get(job_path));
    const auto job = STRATA_TRY(object_in(polled, {"state", "progress"}));
    const std::string state = text_of(job, "state");
    if (state == "done") {
      if (!job.contains("model")) return not_strata("A finished job without a model");
      auto answer = STRATA_TRY(client.get("/api/v1/models/" + job.at("model").dump()));
      const auto model = STRATA_TRY(object_in(answer, {"id", "name"}));
      return model.dump(2);
    }
    if (state == "failed" || state == "cancelled")
      return tl::unexpected(
          problem_of(job.value("problem", nlohmann::json()), 422, "Import " + state, state));
    if (state != "queued" && state != "running")
      return not_strata("A job with the state `" + state + "`");
    progress.report(job.at("progress").is_number() ? job.at("progress").get<double>() : 0,
                    text_of(job, "message"));
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
}

}  // namespace strata::cli
