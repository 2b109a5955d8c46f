#include "store/content/bills.h"

#include "store/pg/pg_row.h"
#include "store/pg/sql.h"
#include "store/store_impl.h"

namespace strata::store {
namespace {

StoredBill read_bill(const PgResult& rows, int i) {
  PgRow row(rows, i);
  return {row.id<BillId>(),
          row.id<ProjectId>(),
          row.text(),
          row.json(),
          static_cast<int>(row.integer()),
          row.integer()};
}

Result<StoredBill> load_bill(PgConnection& connection, ProjectId project_id, BillId id) {
  auto rows = STRATA_TRY(
      connection.query("SELECT id, project_id, name, content, positions, version FROM bills "
                       "WHERE project_id = $1 AND id = $2",
                       Params().id(project_id).id(id)));
  if (rows.rows() == 0) return no_such("bill", to_string(id));
  return read_bill(rows, 0);
}

// Locks the project, so that concurrent transactions cannot take a name twice or exceed the limit
// together. Refuses a name that another bill has.
Result<void> lock_bill_name(PgConnection& connection, const StoredBill& bill) {
  auto project = STRATA_TRY(connection.query(
      "SELECT 1 FROM projects WHERE id = $1 FOR NO KEY UPDATE", Params().id(bill.project_id)));
  if (project.rows() == 0) return no_such("project", to_string(bill.project_id));
  auto others = STRATA_TRY(connection.query(
      "SELECT 1 FROM bills WHERE project_id = $1 AND lower(name) = lower($2) AND id <> $3",
      Params().id(bill.project_id).text(bill.name).id(bill.id)));
  if (others.rows() == 0) return {};
  return fail(
      ErrorCode::conflict, "Name already used",
      "The project already has a bill with the name `" + bill.name + "`. Choose another name.",
      "name");
}

Result<void> lock_bill(PgConnection& connection, const StoredBill& bill) {
  auto rows = STRATA_TRY(
      connection.query("SELECT version FROM bills WHERE project_id = $1 AND id = $2 FOR UPDATE",
                       Params().id(bill.project_id).id(bill.id)));
  if (rows.rows() == 0) return no_such("bill", to_string(bill.id));
  if (rows.integer(0, 0) != bill.version) return stale("bill");
  return {};
}

}  // namespace

Result<std::vector<StoredBill>> Bills::of_project(ProjectId project_id) {
  return pool_.read([&](PgConnection& connection) -> Result<std::vector<StoredBill>> {
    auto rows = STRATA_TRY(
        connection.query("SELECT id, project_id, name, '{}'::jsonb, positions, version FROM bills "
                         "WHERE project_id = $1 ORDER BY id",
                         Params().id(project_id)));
    std::vector<StoredBill> bills;
    for (int i = 0; i < rows.rows(); ++i) bills.push_back(read_bill(rows, i));
    return bills;
  });
}

Result<StoredBill> Bills::find(ProjectId project_id, BillId id) {
  return pool_.read(
      [&](PgConnection& connection) { return load_bill(connection, project_id, id); });
}

Result<StoredBill> Bills::create(const StoredBill& bill,
                                 const IdempotentResponse<StoredBill>& answer) {
  STRATA_TRY(check_name(bill.name));
  return change(pool_, answer, [&](PgConnection& connection) -> Result<StoredBill> {
    STRATA_TRY(lock_bill_name(connection, bill));
    auto count = STRATA_TRY(connection.query("SELECT count(*) FROM bills WHERE project_id = $1",
                                             Params().id(bill.project_id)));
    if (count.integer(0, 0) >= kMaxBills)
      return fail(
          ErrorCode::conflict, "Too many bills",
          "A project can have at most " + std::to_string(kMaxBills) + " bills. Delete some first.");
    auto made = STRATA_TRY(connection.query(
        "INSERT INTO bills (project_id, name, content, positions) VALUES ($1, $2, $3, $4) "
        "RETURNING id",
        Params().id(bill.project_id).text(bill.name).json(bill.content).integer(bill.positions)));
    return load_bill(connection, bill.project_id, made.id<BillId>(0, 0));
  });
}

Result<StoredBill> Bills::replace(const StoredBill& bill,
                                  const IdempotentResponse<StoredBill>& answer) {
  STRATA_TRY(check_name(bill.name));
  return change(pool_, answer, [&](PgConnection& connection) -> Result<StoredBill> {
    STRATA_TRY(lock_bill_name(connection, bill));
    STRATA_TRY(lock_bill(connection, bill));
    STRATA_TRY(connection.query(
        "UPDATE bills SET name = $2, content = $3, positions = $4, version = version + 1 "
        "WHERE id = $1",
        Params().id(bill.id).text(bill.name).json(bill.content).integer(bill.positions)));
    return load_bill(connection, bill.project_id, bill.id);
  });
}

Result<void> Bills::remove(const StoredBill& bill, const IdempotentResponse<>& answer) {
  return change(pool_, answer, [&](PgConnection& connection) -> Result<void> {
    STRATA_TRY(lock_bill(connection, bill));
    auto done = connection.query("DELETE FROM bills WHERE id = $1", Params().id(bill.id));
    return done ? Result<void>() : tl::unexpected(done.error());
  });
}

}  // namespace strata::store
