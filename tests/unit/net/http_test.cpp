#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <future>
#include <thread>

#include "core/byte_budget.h"
#include "core/text/markup.h"
#include "core/uuid.h"
#include "net/api/node_redirect.h"
#include "net/api/problems_page.h"
#include "net/http/accept.h"
#include "net/http/form_files.h"
#include "net/http/http_types.h"
#include "net/http/origin.h"
#include "net/http/static_files.h"
#include "net/http/token_bucket.h"
#include "net/http/upload.h"
#include "net/http/worker_pool.h"
#include "net/serialization/point_text.h"

namespace strata::net {
namespace {

namespace fs = std::filesystem;

Request parsed(const std::string& target) {
  Request request;
  EXPECT_TRUE(parse_target(target, request)) << target;
  return request;
}

class Folder {
 public:
  Folder()
      : path_(fs::temp_directory_path() /
              ("strata-net-" + std::to_string(::getpid()) + "-" + to_string(random_uuid()))) {
    fs::create_directories(path_);
  }
  ~Folder() { fs::remove_all(path_); }
  fs::path write(const std::string& name, const std::string& text) const {
    fs::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name, std::ios::binary) << text;
    return path_ / name;
  }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

std::string text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// --- Targets

TEST(Target, path_and_query_are_decoded) {
  const Request request = parsed("/models/muro%203?coords=POINT+Z(1%202%203)&f=csv");
  EXPECT_EQ(request.path, "/models/muro 3");
  EXPECT_EQ(request.segments.back(), "muro 3");
  EXPECT_EQ(request.query.at("coords"), "POINT Z(1 2 3)");
  EXPECT_EQ(request.query.at("f"), "csv");
}

TEST(Target, what_is_not_an_address_is_refused) {
  for (const char* target : {"", "models", "/a%2", "/a%zz", "/a%00", "/a?b=%", "/a?b=%00", "*",
                             "/a/%ff", "/a?b=%c3", "/a?%80=b"}) {
    Request request;
    const auto result = parse_target(target, request);
    ASSERT_FALSE(result) << target;
    EXPECT_EQ(result.error().code, ErrorCode::malformed);
  }
}

TEST(Target, a_query_parameter_given_twice_is_refused) {
  Request request;
  const auto result = parse_target("/a?limit=1&limit=2", request);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().field, "limit");
}

// --- Responses

TEST(Respond, only_the_first_answer_counts) {
  std::vector<int> answers;
  {
    const Respond respond([&](const Response& response) { answers.push_back(response.status); });
    respond(empty_response(204));
    respond(Error{ErrorCode::internal, "Too late", "", {}});
  }
  EXPECT_EQ(answers, std::vector<int>{204});
}

TEST(Respond, a_dropped_request_still_gets_an_answer) {
  int status = 0;
  {
    const Respond respond([&](const Response& response) { status = response.status; });
  }
  EXPECT_EQ(status, 503);
}

TEST(Problems, carry_what_rfc_9457_names_and_the_field) {
  const Response response =
      problem_response({ErrorCode::invalid, "Not a point", "Write it so.", "coords"});
  EXPECT_EQ(response.header("Content-Type"), "application/problem+json");
  const auto json = nlohmann::json::parse(response.body);
  EXPECT_EQ(json["status"], 422);
  EXPECT_EQ(json["title"], "Not a point");
  EXPECT_EQ(json["field"], "coords");
}

// --- Cookies and origins

TEST(Cookie, is_found_among_others) {
  EXPECT_EQ(cookie_value("a=1; strata_session=abc; b=2", "strata_session"), "abc");
  EXPECT_EQ(cookie_value("strata_session=\"abc\"", "strata_session"), "abc");
  EXPECT_EQ(cookie_value("xstrata_session=no; strata_session_=no", "strata_session"), "");
  EXPECT_EQ(cookie_value("strata_session", "strata_session"), "");
  EXPECT_EQ(cookie_value("", "strata_session"), "");
}

Request from(const std::string& origin, bool by_cookie) {
  Request request;
  request.headers = {{"host", "strata.local:8080"}};
  if (!origin.empty()) request.headers.emplace_back("origin", origin);
  request.principal = Principal{"owner", Role::owner, by_cookie};
  return request;
}

TEST(Origin, a_change_signed_by_cookie_comes_from_our_own_pages) {
  EXPECT_TRUE(check_same_origin(from("http://strata.local:8080", true), {}));
  EXPECT_TRUE(check_same_origin(from("http://STRATA.local:8080", true), {}));
  EXPECT_FALSE(check_same_origin(from("http://strata.local", true), {}));
  EXPECT_FALSE(check_same_origin(from("http://evil.example", true), {}));
  EXPECT_FALSE(check_same_origin(from("http://strata.local:8080.evil.example", true), {}));
  EXPECT_FALSE(check_same_origin(from("null", true), {}));
  EXPECT_TRUE(check_same_origin(from("https://museum.example", true), {"https://museum.example/"}));
}

TEST(Origin, its_scheme_is_that_by_which_the_request_came) {
  Request request = from("https://strata.local:8080", true);
  EXPECT_FALSE(check_same_origin(request, {}));
  EXPECT_FALSE(check_upgrade_origin(request, {}));
  EXPECT_TRUE(check_same_origin(request, {"https://strata.local:8080"}));
  request.headers.emplace_back("x-forwarded-proto", "https");
  EXPECT_TRUE(check_same_origin(request, {}));
  request = from("http://strata.local:8080", true);
  request.by_tls = true;
  EXPECT_FALSE(check_same_origin(request, {}));
}

Request asking(const std::string& host) {
  Request request;
  request.headers = {{"host", host}};
  return request;
}

TEST(Host, is_an_address_or_one_of_the_servers_names) {
  const auto names =
      own_names("Strata.Local",
                {"https://museum.example", "http://Find.example:8080/", "https://[2001:db8::7]"});
  for (const char* host : {"localhost", "localhost:8080", "LOCALHOST:1", "strata.local:8080",
                           "museum.example", "museum.example.", "find.example:99", "127.0.0.1",
                           "192.0.2.7:8080", "[::1]:8080", "[2001:db8::1]"})
    EXPECT_TRUE(check_host(asking(host), names)) << host;
  for (const char* host :
       {"evil.example", "evil.example:8080", "museum.example.evil.example", "xmuseum.example",
        "127.0.0.1.evil.example", "1.2.3", "[::1].evil.example", "[evil.example]",
        "localhost.evil.example", ":8080", " "}) {
    const auto checked = check_host(asking(host), names);
    ASSERT_FALSE(checked) << host;
    EXPECT_EQ(checked.error().code, ErrorCode::misdirected);
    EXPECT_EQ(checked.error().field, "Host");
  }
}

TEST(Host, of_scripts_with_a_token_may_be_any) {
  Request request = asking("strata:8080");
  EXPECT_FALSE(check_host(request, own_names("0.0.0.0", {})));
  request.headers.emplace_back("authorization", "Bearer x");
  EXPECT_TRUE(check_host(request, own_names("0.0.0.0", {})));
}

TEST(Origin, without_an_origin_the_browser_must_say_same_origin) {
  Request request = from("", true);
  EXPECT_EQ(check_same_origin(request, {}).error().code, ErrorCode::forbidden);
  request.headers.emplace_back("sec-fetch-site", "same-origin");
  EXPECT_TRUE(check_same_origin(request, {}));
  request.headers.back().second = "cross-site";
  EXPECT_FALSE(check_same_origin(request, {}));
}

TEST(Origin, bearer_tokens_need_none) { EXPECT_TRUE(check_same_origin(from("", false), {})); }

TEST(Origin, signing_in_from_a_foreign_page_is_refused) {
  Request request = from("http://evil.example", false);
  request.principal.reset();
  EXPECT_FALSE(check_same_origin(request, {}));
  EXPECT_TRUE(check_same_origin(Request{}, {}));
}

TEST(Origin, an_upgrade_by_cookie_needs_an_origin_and_by_token_does_not) {
  EXPECT_FALSE(check_upgrade_origin(from("", true), {}));
  EXPECT_TRUE(check_upgrade_origin(from("", false), {}));
  EXPECT_FALSE(check_upgrade_origin(from("http://evil.example", false), {}));
  EXPECT_TRUE(check_upgrade_origin(from("http://strata.local:8080", true), {}));
}

// --- Types that a client accepts

TEST(Accept, takes_a_type_by_its_closest_range) {
  EXPECT_TRUE(accepts_type("", "application/json"));
  EXPECT_TRUE(accepts_type("*/*", "image/png"));
  EXPECT_TRUE(accepts_type("text/html, */*;q=0.1", "application/json"));
  EXPECT_TRUE(accepts_type("application/json", "application/json"));
  EXPECT_TRUE(accepts_type("APPLICATION/JSON; q=0.5", "application/json; charset=utf-8"));
  EXPECT_TRUE(accepts_type("application/json", "application/prs.coverage+json"));
  EXPECT_TRUE(accepts_type("image/*", "image/png"));
  EXPECT_FALSE(accepts_type("application/xml", "application/json"));
  EXPECT_FALSE(accepts_type("application/json;q=0", "application/json"));
  EXPECT_FALSE(accepts_type("*/*, application/json;q=0", "application/json"));
  EXPECT_FALSE(accepts_type("image/*", "text/csv"));
  EXPECT_FALSE(accepts_type("application/json", "application/xml"));
  EXPECT_FALSE(accepts_type(",;q=x", "application/json"));
  for (const char* quality : {"8.1", "-0.5", "nan", "inf"})
    EXPECT_FALSE(accepts_type(std::string("*/*;q=") + quality, "application/json")) << quality;
}

// --- Points

TEST(Point, is_read_in_every_spelling) {
  for (const char* text : {"POINT Z(1 -2.5 3e2)", "POINT Z (1 -2.5 3e2)", "point(1 -2.5 3e2)",
                           "PointZ(1  -2.5\t3e2)", " POINT Z( +1 -2.5 3e2 ) "}) {
    const auto point = parse_point(text);
    ASSERT_TRUE(point) << text;
    EXPECT_EQ(*point, glm::dvec3(1, -2.5, 300)) << text;
  }
}

TEST(Point, what_is_no_point_is_refused_by_field) {
  for (const char* text :
       {"", "POINT", "POINT Z()", "POINT Z(1 2)", "POINT Z(1 2 3 4)", "POINT Z(1,2,3)",
        "POINT Z(nan 1 2)", "POINT Z(1 2 inf)", "POINT Z(1 2 1e999)", "POINT Z(1 2 3",
        "POINT Z(1 2 3) x", "LINE(1 2 3)", "POINT Z(1 2.3.4)", "POINT M(1 2 3)"}) {
    const auto point = parse_point(text);
    ASSERT_FALSE(point) << text;
    EXPECT_EQ(point.error().field, "coords");
  }
}

// --- Rates

TEST(TokenBucket, lets_a_burst_pass_and_then_the_rate) {
  const auto start = TokenBucket::Clock::now();
  TokenBucket bucket(10, 3, start);
  EXPECT_TRUE(bucket.take(start));
  EXPECT_TRUE(bucket.take(start));
  EXPECT_TRUE(bucket.take(start));
  EXPECT_FALSE(bucket.take(start));
  EXPECT_TRUE(bucket.take(start + std::chrono::milliseconds(101)));
  EXPECT_FALSE(bucket.take(start + std::chrono::milliseconds(102)));
  const auto later = start + std::chrono::hours(1);
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(bucket.take(later));
  EXPECT_FALSE(bucket.take(later)) << "an idle hour earns one burst, not 36 000";
}

TEST(TokenBucket, tells_what_is_left_and_when_it_is_full) {
  const auto start = TokenBucket::Clock::now();
  TokenBucket bucket(10, 30, start);
  EXPECT_EQ(bucket.left(start), 30);
  EXPECT_EQ(bucket.full_in_s(start), 0);
  for (int i = 0; i < 15; ++i) bucket.take(start);
  EXPECT_EQ(bucket.left(start), 15);
  EXPECT_EQ(bucket.full_in_s(start), 2);
  EXPECT_EQ(bucket.left(start + std::chrono::milliseconds(1050)), 25);
}

TEST(TokenBucket, a_clock_that_steps_back_earns_nothing) {
  const auto start = TokenBucket::Clock::now();
  TokenBucket bucket(10, 1, start);
  EXPECT_TRUE(bucket.take(start));
  EXPECT_FALSE(bucket.take(start - std::chrono::hours(1)));
  EXPECT_FALSE(bucket.take(start));
}

TEST(WorkerPool, refuses_when_too_much_waits_and_ends_what_it_took) {
  std::promise<void> gate;
  auto open = gate.get_future().share();
  std::promise<void> started;
  std::atomic<int> done{0};
  WorkerPool pool(1, 1);
  ASSERT_TRUE(pool.post([&] {
    started.set_value();
    open.wait();
    ++done;
  }));
  started.get_future().wait();
  EXPECT_TRUE(pool.post([&] { ++done; }));
  EXPECT_FALSE(pool.post([&] { ++done; }));
  gate.set_value();
  pool.stop();
  EXPECT_EQ(done, 2);
  EXPECT_FALSE(pool.post([] {}));
}

// --- Files of the page

TEST(StaticFiles, serves_files_with_type_and_version) {
  const Folder folder;
  folder.write("index.html", "<p>page</p>");
  folder.write("assets/app-1a2b.js", "run()");
  folder.write("guide/sample.pdf", "%PDF-1.7");
  const StaticFiles files(folder.path());
  EXPECT_EQ(files.serve(parsed("/guide/sample.pdf")).header("Content-Type"), "application/pdf");
  const Response script = files.serve(parsed("/assets/app-1a2b.js"));
  EXPECT_EQ(script.header("Content-Type"), "text/javascript; charset=utf-8");
  EXPECT_NE(script.header("Cache-Control").find("immutable"), std::string_view::npos);
  EXPECT_EQ(text_of(script.file), "run()");

  Request again = parsed("/assets/app-1a2b.js");
  again.headers = {{"if-none-match", std::string(script.header("ETag"))}};
  EXPECT_EQ(files.serve(again).status, 304);
}

TEST(StaticFiles, addresses_of_the_page_are_the_page) {
  const Folder folder;
  folder.write("index.html", "<p>page</p>");
  const StaticFiles files(folder.path());
  for (const char* target : {"/", "/models/pot", "/projects/default", "/models/pot/layers/cracks"})
    EXPECT_EQ(text_of(files.serve(parsed(target)).file), "<p>page</p>") << target;
  EXPECT_EQ(files.serve(parsed("/nothing.js")).status, 404);
}

TEST(StaticFiles, the_contract_has_a_page_of_its_own) {
  const Folder folder;
  folder.write("index.html", "<p>page</p>");
  folder.write("docs.html", "<p>contract</p>");
  const StaticFiles files(folder.path());
  for (const char* target : {"/docs", "/api/v1/docs"})
    EXPECT_EQ(text_of(files.serve(parsed(target)).file), "<p>contract</p>") << target;
}

TEST(StaticFiles, pages_of_the_guide_have_addresses_without_an_ending) {
  const Folder folder;
  folder.write("index.html", "<p>page</p>");
  folder.write("guide/index.html", "<p>guide</p>");
  folder.write("guide/how-to/index.html", "<p>how to</p>");
  folder.write("guide/how-to/measure.html", "<p>measure</p>");
  folder.write("guide/assets/app.1a2b.js", "run()");
  folder.write("guide/404.html", "<p>missing</p>");
  const StaticFiles files(folder.path());
  const std::vector<std::pair<const char*, const char*>> pages = {
      {"/guide", "<p>guide</p>"},
      {"/guide/", "<p>guide</p>"},
      {"/guide/how-to/", "<p>how to</p>"},
      {"/guide/how-to/measure", "<p>measure</p>"},
      {"/guide/how-to/measure.html", "<p>measure</p>"}};
  for (const auto& [target, text] : pages) {
    const Response response = files.serve(parsed(target));
    EXPECT_EQ(response.status, 200) << target;
    EXPECT_EQ(text_of(response.file), text) << target;
    EXPECT_EQ(response.header("Cache-Control"), "no-cache") << target;
  }
  EXPECT_NE(
      files.serve(parsed("/guide/assets/app.1a2b.js")).header("Cache-Control").find("immutable"),
      std::string_view::npos);

  const Response missing = files.serve(parsed("/guide/assets/nothing.js"));
  EXPECT_EQ(missing.status, 404);
  EXPECT_EQ(text_of(missing.file), "<p>missing</p>");
  EXPECT_EQ(missing.header("Cache-Control"), "no-cache");
  Request again = parsed("/guide/nothing");
  again.headers = {{"if-none-match", std::string(missing.header("ETag"))}};
  EXPECT_EQ(files.serve(again).status, 404);
  EXPECT_EQ(files.serve(parsed("/guide/%2e%2e/index.html")).status, 404);
}

TEST(StaticFiles, a_page_without_a_guide_has_none_at_its_address) {
  const Folder folder;
  folder.write("index.html", "<p>page</p>");
  EXPECT_EQ(StaticFiles(folder.path()).serve(parsed("/guide")).status, 404);
}

TEST(StaticFiles, nothing_outside_the_folder_is_served) {
  const Folder outside;
  const auto secret = outside.write("secret.txt", "secret");
  const Folder folder;
  folder.write("index.html", "<p>page</p>");
  folder.write(".env", "secret");
  fs::create_symlink(secret, folder.path() / "link.txt");
  const StaticFiles files(folder.path());
  for (const std::string& target :
       {std::string("/../") + outside.path().filename().string() + "/secret.txt",
        std::string("/%2e%2e/secret.txt"), std::string("/..%2f..%2fetc%2fpasswd"),
        std::string("/link.txt"), std::string("/.env"), std::string("/a\\..\\b")})
    EXPECT_EQ(files.serve(parsed(target)).status, 404) << target;
}

TEST(StaticFiles, a_missing_page_says_so) {
  const Folder folder;
  EXPECT_EQ(StaticFiles(folder.path()).serve(parsed("/")).status, 503);
}

// --- Uploads

Request upload_of(const fs::path& file, const std::string& type) {
  Request request;
  request.body_file = file;
  if (!type.empty()) request.headers = {{"content-type", type}};
  return request;
}

TEST(Upload, a_raw_body_is_the_file_itself) {
  const Folder folder;
  const auto body = folder.write("1.body", "ply\n");
  const auto upload = take_upload(upload_of(body, "application/octet-stream"), folder.path());
  ASSERT_TRUE(upload);
  ASSERT_EQ(upload->size(), 1u);
  EXPECT_EQ(upload->front().file, body);
}

TEST(Upload, the_one_file_of_a_form_is_cut_out_bit_for_bit) {
  const Folder folder;
  const std::string content = std::string("ply\r\n--not-the-boundary\r\n\0binary", 32);
  const auto body = folder.write(
      "1.body",
      "--X\r\nContent-Disposition: form-data; name=\"note\"\r\n\r\nhello\r\n"
      "--X\r\nContent-Disposition: form-data; name=\"file\"; filename=\"C:\\scans\\pot.ply\"\r\n\r\n" +
          content + "\r\n--X--\r\n");
  const auto upload =
      take_upload(upload_of(body, "multipart/form-data; boundary=X"), folder.path());
  ASSERT_TRUE(upload) << upload.error().detail;
  ASSERT_EQ(upload->size(), 1u);
  EXPECT_EQ(upload->front().filename, "scans/pot.ply");
  EXPECT_EQ(text_of(upload->front().file), content);
}

TEST(Upload, the_files_of_a_scan_come_together_with_their_folders) {
  const Folder folder;
  const auto part = [](const std::string& name, const std::string& content) {
    return "--X\r\nContent-Disposition: form-data; name=\"f\"; filename=\"" + name + "\"\r\n\r\n" +
           content + "\r\n";
  };
  const auto take = [&](const std::string& body) {
    return take_upload(upload_of(folder.write("1.body", body), "multipart/form-data; boundary=X"),
                       folder.path());
  };
  const auto scan = take(part("scan/a.obj", "v 1") + part("scan/../tex/b.jpg", "") +
                         part("../../c.mtl", "x") + "--X--\r\n");
  ASSERT_TRUE(scan) << scan.error().detail;
  ASSERT_EQ(scan->size(), 3u);
  EXPECT_EQ((*scan)[0].filename, "scan/a.obj");
  EXPECT_EQ((*scan)[1].filename, "scan/tex/b.jpg");
  EXPECT_EQ(text_of((*scan)[1].file), "");
  EXPECT_EQ((*scan)[2].filename, "c.mtl") << "nothing leads out of the upload";
  const auto files_there = [&] {
    return std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator());
  };
  const auto before = files_there();
  EXPECT_EQ(take(part("a.obj", "1") + part("a.obj", "2") + "--X--\r\n").error().code,
            ErrorCode::invalid);
  std::string many;
  for (std::size_t i = 0; i <= kMaxFormFiles; ++i) many += part("f" + std::to_string(i), "x");
  EXPECT_EQ(take(many + "--X--\r\n").error().code, ErrorCode::too_large);
  EXPECT_EQ(
      take("--X\r\nContent-Disposition: form-data; name=\"f\"\r\n\r\nv\r\n--X--\r\n").error().code,
      ErrorCode::unsupported);
  EXPECT_EQ(files_there(), before) << "what was refused left nothing behind";
}

TEST(Upload, a_file_is_named_by_its_own_part_alone) {
  const auto names = [](const std::string& parts) {
    std::vector<std::string> found;
    const std::string body = parts + "--X--\r\n";
    const auto files = files_of_form("multipart/form-data; charset=x; boundary=\"X\"", body);
    EXPECT_TRUE(files) << parts;
    if (files)
      for (const auto& file : *files) found.push_back(file.filename);
    return found;
  };
  const std::string note = "Content-Disposition: form-data; name=\"note\"\r\n",
                    text = "\r\ntext; filename=no.ply\r\n";
  const std::string file =
      "content-disposition: form-data ; name=f; FileName = \"a;b.ply\" ; size=3\r\n";
  EXPECT_THAT(names("--X\r\n" + text + "--X\r\n" + file + text), testing::ElementsAre("a;b.ply"))
      << "an empty head";
  EXPECT_THAT(names("--X\r\n" + note + "X-Other: a; filename=\"no.ply\"\r\n" + text),
              testing::IsEmpty());
  EXPECT_THAT(
      names("--X\r\nContent-Disposition: form-data; name=\"a; filename=no.ply\"\r\n" + text),
      testing::IsEmpty());
  EXPECT_THAT(names("--X\r\nContent-Disposition: form-data; filename=\"open.ply\r\n" + text),
              testing::ElementsAre("open.ply"));
  EXPECT_THAT(names("--X\r\nContent-Disposition: form-data; filename=Gr\xf6\xdf/a.ply\r\n" + text),
              testing::ElementsAre("Gr\ufffd\ufffd/a.ply"));
  EXPECT_THAT(
      names("--X\r\nContent-Disposition: form-data; filename*=UTF-8''a; filename=\r\n" + text),
      testing::IsEmpty());
}

TEST(Upload, a_zip_is_known_by_its_type) {
  const Folder folder;
  const auto zip =
      take_upload(upload_of(folder.write("1.body", "PK"), "application/zip"), folder.path());
  ASSERT_TRUE(zip);
  EXPECT_EQ(zip->front().filename, "scan.zip");
}

TEST(Upload, broken_forms_are_refused) {
  const Folder folder;
  for (const char* body : {"--X", "--X\r\n", "--X\r\nno end of headers",
                           "--X\r\nA: b\r\n\r\nno boundary", "X--", "--Y\r\n\r\n\r\n--Y--"}) {
    const auto upload = take_upload(
        upload_of(folder.write("1.body", body), "multipart/form-data; boundary=X"), folder.path());
    ASSERT_FALSE(upload) << body;
    EXPECT_EQ(upload.error().code, ErrorCode::malformed) << body;
  }
  EXPECT_FALSE(take_upload(upload_of(folder.write("2.body", ""), ""), folder.path()));
}

TEST(ByteBudget, what_is_held_bounds_what_may_be_taken) {
  ByteBudget budget(100);
  auto first = budget.take(60);
  ASSERT_TRUE(first);
  EXPECT_EQ(budget.take(50).error().code, ErrorCode::busy);
  auto second = budget.take(40);
  ASSERT_TRUE(second);
  auto copy = *first;
  first->reset();
  EXPECT_FALSE(budget.take(1)) << "a copy still holds it";
  copy.reset();
  second->reset();
  auto large = budget.take(1000);
  ASSERT_TRUE(large) << "alone it may be larger than the budget";
  EXPECT_FALSE(budget.take(1));
}

// --- Pages and figures

TEST(Problems, text_cannot_become_markup) {
  EXPECT_EQ(escaped_markup("<a href=\"x\">&'"), "&lt;a href=&quot;x&quot;&gt;&amp;&#39;");
}

TEST(Problems, all_of_it_is_the_main_part_and_every_column_has_a_head) {
  const std::string page = problems_html();
  EXPECT_EQ(page.find("<script"), std::string::npos);
  EXPECT_NE(page.find("<body><main><h1>"), std::string::npos);
  EXPECT_TRUE(page.ends_with("</main></body></html>"));
  EXPECT_EQ(page.find("<th></th>"), std::string::npos);
  EXPECT_NE(page.find("<th scope=\"col\">Meaning</th>"), std::string::npos);
}

TEST(Moved, a_handler_redirects_a_request_once) {
  const Response first =
      redirected_by_handler("https://museum.example/node/b", "/api/v1/tables/3/records", false);
  EXPECT_EQ(first.status, 307);
  EXPECT_EQ(first.header("Location"),
            "https://museum.example/node/b/api/v1/tables/3/records?moved=1");
  EXPECT_EQ(first.header("Content-Type"), "application/problem+json");
  EXPECT_NE(first.body.find("/problems#moved"), std::string::npos);

  Request request;
  ASSERT_TRUE(parse_target("/api/v1/tables/3/records?limit=5&moved=1", request));
  EXPECT_TRUE(request.was_moved);
  EXPECT_EQ(request.target, "/api/v1/tables/3/records?limit=5");
  EXPECT_EQ(request.query, (std::map<std::string, std::string>{{"limit", "5"}}));
  EXPECT_EQ(redirected_by_handler("https://museum.example/node/c", request.target, true).status,
            503);
}

TEST(Moved, only_the_mark_of_a_redirection_is_removed) {
  const auto parsed = [](std::string_view target) {
    Request request;
    EXPECT_TRUE(parse_target(target, request));
    return std::pair(request.target, request.was_moved);
  };
  EXPECT_EQ(parsed("/x?moved=1"), std::pair(std::string("/x"), true));
  EXPECT_EQ(parsed("/x?removed=1"), std::pair(std::string("/x?removed=1"), false));
  EXPECT_EQ(parsed("/x?moved=1&y=2"), std::pair(std::string("/x?moved=1&y=2"), false));
  EXPECT_EQ(parsed("/moved=1"), std::pair(std::string("/moved=1"), false));
}

TEST(Moved, the_query_of_a_redirected_request_is_kept) {
  EXPECT_EQ(redirected_by_handler("http://b", "/x?limit=5", false).header("Location"),
            "http://b/x?limit=5&moved=1");
}

TEST(Moved, a_request_is_repeated_later_if_the_node_is_not_known) {
  const Response response = redirected_by_handler({}, "/x", false);
  EXPECT_EQ(response.status, 503);
  EXPECT_EQ(response.header("Retry-After"), "1");
  EXPECT_EQ(response.header("Location"), "");
}

TEST(Moved, a_problem_has_the_address_of_the_node) {
  EXPECT_EQ(problem_response(moved_to("http://b")).header("Location"), "http://b");
  EXPECT_EQ(problem_response(moved_to({})).header("Location"), "");
  EXPECT_EQ(problem_response(moved_to({})).status, 307);
}

}  // namespace
}  // namespace strata::net
