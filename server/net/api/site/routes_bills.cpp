// Bills of quantities of a project. Only curators can read and change them, because they contain
// prices, and because their rules name layers and columns that other users may not see.
#include <algorithm>
#include <chrono>

#include "app/bills/bill_workbook.h"
#include "app/bills/measured_bill.h"
#include "bill/check_bill.h"
#include "bill/gaeb.h"
#include "bill/items.h"
#include "core/mapped_file.h"
#include "core/text/slug.h"
#include "core/text/timestamp.h"
#include "domain/people/role.h"
#include "domain/scene/model.h"
#include "net/api/addressed.h"
#include "net/api/annotated_routes.h"
#include "net/api/routes.h"
#include "net/auth/project_authorization.h"
#include "net/http/idempotency_store.h"
#include "net/http/page.h"
#include "net/http/upload.h"
#include "net/transport/server_options.h"
#include "store/content/bills.h"
#include "store/content/projects.h"
#include "store/store.h"

namespace strata::net {
namespace {

constexpr std::uint64_t kMaxBillBytes = std::uint64_t{16} << 20;
constexpr const char* kBills = "/api/v1/projects/{project}/bills";
constexpr const char* kGaebUpload = "Send the GAEB DA XML file as the body.";

// --- between the contract and the store

protocol::BillWrite bill_of(const store::StoredBill& stored) {
  protocol::BillWrite bill;
  nlohmann::json json = stored.content;
  json["name"] = stored.name;
  protocol::read(json, bill);
  return bill;
}

nlohmann::json bill_json(const store::StoredBill& stored) {
  nlohmann::json json = stored.content;
  json["id"] = stored.id;
  json["name"] = stored.name;
  json["version"] = stored.version;
  return json;
}

// Puts a bill from a request into its stored form.
void put_content(store::StoredBill& stored, const protocol::BillWrite& bill) {
  stored.name = bill.name;
  stored.content = protocol::to_json(bill);
  stored.content.erase("name");
  if (!stored.content.contains("items")) stored.content["items"] = nlohmann::json::array();
  stored.positions = static_cast<int>(std::ranges::count(
      bill::items_of(bill), protocol::BillItemKind::position, &protocol::BillItem::kind));
}

Result<protocol::BillWrite> bill_in(const Request& request) {
  auto bill = STRATA_TRY(body_of<protocol::BillWrite>(request, kMaxBillBytes));
  STRATA_TRY(bill::check_bill(bill));
  return bill;
}

Result<store::StoredBill> stored_bill(const RouteContext& context, const Request& request) {
  const auto project = STRATA_TRY(stored_project(context, request));
  const auto id = STRATA_TRY(id_of<store::BillId>(request, "bill"));
  return context.store.bills().find(project.id, id);
}

std::string now() { return utc_text(std::chrono::system_clock::now()); }

// --- reading and changing

Result<Response> list_bills(const RouteContext& context, const Request& request) {
  const auto page = STRATA_TRY(page_of(request));
  const auto project = STRATA_TRY(stored_project(context, request));
  const auto all = STRATA_TRY(context.store.bills().of_project(project.id));
  const auto part = STRATA_TRY(slice_by(
      page, all, [](const store::StoredBill& bill) { return NumberKey{bill.id.number()}; }));
  nlohmann::json list = nlohmann::json::array();
  for (std::size_t i = part.begin; i < part.end; ++i)
    list.push_back({{"id", all[i].id},
                    {"name", all[i].name},
                    {"positions", all[i].positions},
                    {"version", all[i].version}});
  Response response = json_response({{"bills", std::move(list)}, {"total", all.size()}});
  add_page_links(response, request, page, part.last);
  return response;
}

Result<Response> get_bill(const RouteContext& context, const Request& request) {
  const auto bill = STRATA_TRY(stored_bill(context, request));
  return with_etag(json_response(bill_json(bill)), request, bill.version);
}

Response created_bill(const Project& project, const store::StoredBill& made, nlohmann::json json) {
  return json_response(json, 201)
      .with("Location", "/api/v1/projects/" + project.slug + "/bills/" + to_string(made.id))
      .with("ETag", etag_of(made.version));
}

Result<Response> create_bill(const RouteContext& context, const Request& request) {
  auto bill = STRATA_TRY(bill_in(request));
  const auto project = STRATA_TRY(stored_project(context, request));
  bill::sign_measurements(bill, {}, request.user(), now());
  store::StoredBill fresh;
  fresh.project_id = project.id;
  put_content(fresh, bill);
  const auto answer = [&](const store::StoredBill& made) {
    return created_bill(project, made, bill_json(made));
  };
  const auto made = STRATA_TRY(
      context.store.bills().create(fresh, idempotent_response<store::StoredBill>(request, answer)));
  return answer(made);
}

Result<Response> replace_bill(const RouteContext& context, const Request& request) {
  auto bill = STRATA_TRY(bill_in(request));
  auto stored = STRATA_TRY(stored_bill(context, request));
  STRATA_TRY(check_if_match(request, stored.version));
  bill::sign_measurements(bill, bill_of(stored), request.user(), now());
  put_content(stored, bill);
  const auto answer = [](const store::StoredBill& changed) {
    return json_response(bill_json(changed)).with("ETag", etag_of(changed.version));
  };
  const auto changed = STRATA_TRY(context.store.bills().replace(
      stored, idempotent_response<store::StoredBill>(request, answer)));
  return answer(changed);
}

Result<Response> delete_bill(const RouteContext& context, const Request& request) {
  const auto bill = STRATA_TRY(stored_bill(context, request));
  STRATA_TRY(check_if_match(request, bill.version));
  const auto answer = [] { return empty_response(204); };
  STRATA_TRY(context.store.bills().remove(bill, idempotent_response<>(request, answer)));
  return answer();
}

// --- files and quantities

Result<Response> import_bill(const RouteContext& context, const Request& request) {
  const auto project = STRATA_TRY(stored_project(context, request));
  const auto uploads = STRATA_TRY(take_upload(request, context.options.upload_dir, kGaebUpload));
  const UploadedFiles cut_out(uploads, request.body_file);
  if (uploads.size() != 1)
    return fail(ErrorCode::invalid, "Too many files", "Send one GAEB file at a time.", "body");
  const auto file = STRATA_TRY(MappedFile::open(uploads.front().file));
  const auto bytes = file.bytes();
  auto read = STRATA_TRY(bill::read_gaeb(
      {reinterpret_cast<const char*>(bytes.data()), bytes.size()}));  // NOLINT: bytes are text
  if (const std::string name = request.query_or("name", {}); !name.empty()) read.bill.name = name;
  if (auto good = bill::check_bill(read.bill); !good) {
    Error problem = good.error();
    problem.field = "body";
    return tl::unexpected(std::move(problem));
  }
  store::StoredBill fresh;
  fresh.project_id = project.id;
  put_content(fresh, read.bill);
  const auto answer = [&](const store::StoredBill& made) {
    return created_bill(
        project, made,
        {{"bill", bill_json(made)}, {"phase", "x" + read.phase}, {"remarks", read.remarks}});
  };
  const auto made = STRATA_TRY(
      context.store.bills().create(fresh, idempotent_response<store::StoredBill>(request, answer)));
  return answer(made);
}

Result<app::MeasuredBill> measure_stored(const RouteContext& context, const Request& request,
                                         const store::StoredBill& stored) {
  app::BillSource source{stored.project_id, request.role(), {}};
  source.language = STRATA_TRY(requested_language(request));
  return app::measured_bill(context, source, bill_of(stored));
}

Result<Response> bill_quantities(const RouteContext& context, const Request& request) {
  const auto stored = STRATA_TRY(stored_bill(context, request));
  const auto measured = STRATA_TRY(measure_stored(context, request, stored));
  nlohmann::json json = app::to_json(measured);
  json["bill"] = stored.id;
  json["version"] = stored.version;
  return json_response(json);
}

Result<Response> bill_file(const RouteContext& context, const Request& request) {
  const std::string format = request.query_or("f", "xlsx");
  const auto phase = bill::parse_gaeb_phase(format);
  if (!phase && format != "xlsx")
    return fail(ErrorCode::not_acceptable, "Unknown format",
                "`f` must be xlsx, x31, x83, x84 or x86.", "f");
  const auto project = STRATA_TRY(stored_project(context, request));
  const auto stored = STRATA_TRY(stored_bill(context, request));
  const auto measured = STRATA_TRY(measure_stored(context, request, stored));
  if (!phase)
    return file_response(STRATA_TRY(app::bill_workbook(measured, context.options.upload_dir)));
  const std::string time = now();  // "2026-12-01T09:30:00.123Z"
  const auto written = bill::write_gaeb(measured.bill, measured.positions, *phase,
                                        {project.name, time.substr(0, 10), time.substr(11, 8)});
  if (!written) {
    Error problem = written.error();
    problem.field = "f";
    return tl::unexpected(std::move(problem));
  }
  Response response = text_response(*written, "application/xml");
  name_download(response, make_slug(stored.name) + "." + format);
  return response;
}

}  // namespace

void add_bill_routes(Router& router, const RouteContext& context) {
  using Answer = Result<Response> (*)(const RouteContext&, const Request&);
  const auto handler = [&context](Answer answer) {
    return answering(
        [&context, answer](const Request& request) { return answer(context, request); });
  };
  const std::string all = kBills, one = all + "/{bill}";
  const auto read = [&](std::string pattern, Answer answer, std::vector<std::string> query,
                        bool is_question) {
    router.add({.method = Method::get,
                .pattern = std::move(pattern),
                .handler = handler(answer),
                .role = Role::curator,
                .query = std::move(query),
                .is_question = is_question});
  };
  const auto change = [&](Method method, std::string pattern, Answer answer) {
    const bool has_body = method != Method::remove;
    router.add({.method = method,
                .pattern = std::move(pattern),
                .handler = handler(answer),
                .role = Role::curator,
                .body = has_body ? BodyKind::memory : BodyKind::none,
                .max_body = has_body ? kMaxBillBytes : 0,
                .keeps_answer = true,
                .needs_version = method != Method::post});
  };
  read(all, list_bills, {"limit", "offset", "after"}, false);
  change(Method::post, all, create_bill);
  router.add(
      {.method = Method::post,
       .pattern = all + "/gaeb",
       .handler = handler(import_bill),
       .role = Role::curator,
       .query = {"name"},
       .body = BodyKind::file,
       .max_body = std::min<std::uint64_t>(bill::kMaxGaebBytes, context.options.max_upload_bytes),
       .keeps_answer = true});
  read(one, get_bill, {}, false);
  change(Method::put, one, replace_bill);
  change(Method::remove, one, delete_bill);
  read(one + "/quantities", bill_quantities, {"lang"}, true);
  read(one + "/file", bill_file, {"lang", "f"}, true);
}

}  // namespace strata::net
