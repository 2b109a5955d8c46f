#include "net/live/live_session.h"

#include <gtest/gtest.h>

#include <deque>

#include "net/auth/auth.h"
#include "net/live/close_codes.h"
#include "net/live/live_sockets.h"
#include "support/shapes.h"
#include "unit/net/fake_room.h"

namespace strata::net {
namespace {

using nlohmann::json;

class FakeSocket final : public LiveSocket {
 public:
  void send_text(std::string text) override { sent.push_back(json::parse(text)); }
  void send_frame(stream::FrameBytes frame) override { frames.push_back(std::move(frame)); }
  void close(int code, std::string) override { close_code = code; }
  void run_after(std::chrono::milliseconds delay, std::function<void()> work) override {
    later.push_back(std::move(work));
    delays.push_back(delay);
  }

  std::vector<json> of(const std::string& op) const {
    std::vector<json> found;
    for (const auto& message : sent)
      if (message["op"] == op) found.push_back(message);
    return found;
  }

  std::vector<json> sent;
  std::vector<stream::FrameBytes> frames;
  std::deque<std::function<void()>> later;
  std::vector<std::chrono::milliseconds> delays;
  int close_code = 0;
};

json camera_json() {
  const json identity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  return {{"view", identity}, {"projection", identity}, {"width", 640}, {"height", 480}};
}

struct Live : testing::Test {
  Live() {
    shared = std::make_shared<LiveShared>();
    shared->metrics = std::make_shared<Metrics>();
    shared->strokes = std::make_shared<app::StrokeTracker>();
    shared->queries = std::make_shared<WorkerPool>(1, 16);
    shared->sockets = std::make_shared<LiveSockets>();
    shared->editors = std::make_shared<app::RecordEditLocks>();
    shared->check_record = [](ProjectId project_id,
                              const app::RecordEditLocks::Record& record) -> Result<void> {
      if (project_id == 1 && record.table == 4) return {};
      return fail(ErrorCode::not_found, "No such table", "There is none.", "table");
    };
    room = std::make_shared<FakeRoom>();
    connect();
  }
  void connect(Role role = Role::owner) {
    if (session) session->on_closed();
    socket = std::make_shared<FakeSocket>();
    session = std::make_shared<LiveSession>(shared, room, "default", Principal{"anna", role, true},
                                            room::Portrait{"Anna Ost"}, std::nullopt, socket);
    shared->sockets->add(socket, session, "secret");
  }
  // Begins or ends editing a record. When editing begins, a worker looks up the record.
  void edit_record(LiveSession& of, std::int64_t key, bool editing,
                   const json& more = json::object()) {
    json message{{"op", "record.edit"}, {"table", 4}, {"key", key}, {"editing", editing}};
    message.update(more);
    const auto work = of.on_text(message.dump());
    EXPECT_EQ(bool(work), editing);
    if (work) work();
  }
  void say(const json& message) { EXPECT_FALSE(session->on_text(message.dump())); }
  void hello() { say({{"op", "hello"}}); }
  json begin(const std::string& id) {
    return {{"op", "stroke.begin"}, {"id", to_string(random_uuid())},
            {"stroke", id},         {"layer", "cracks"},
            {"value", 3},           {"camera", camera_json()},
            {"radius_px", 8}};
  }
  json extend(const std::string& id, int n, const json& path) {
    return {{"op", "stroke.extend"},
            {"id", to_string(random_uuid())},
            {"stroke", id},
            {"n", n},
            {"path", path}};
  }
  std::shared_ptr<LiveShared> shared;
  std::shared_ptr<FakeRoom> room;
  std::shared_ptr<FakeSocket> socket;
  std::shared_ptr<LiveSession> session;
  const std::string stroke = to_string(random_uuid());
};

TEST_F(Live, a_tool_of_the_site_is_looked_for_on_a_worker_before_the_stroke_begins) {
  const auto shape = test::shape(test::in_flag);
  shared->find_tool = [&](const std::string& ref) -> Result<app::FoundTool> {
    if (ref != "12") return fail(ErrorCode::not_found, "Not found", "There is no such tool.");
    return app::FoundTool{12, shape};
  };
  hello();
  auto begun = begin(stroke);
  begun["shape"] = 12;
  auto work = session->on_text(begun.dump());
  ASSERT_TRUE(work);
  work();
  say(extend(stroke, 0, {{1, 1}}));
  ASSERT_EQ(room->edits_.held.size(), 1u);
  EXPECT_EQ(std::get<room::StrokeEdit>(room->edits_.held[0].request.edit).batch.texture, shape);

  auto unknown = begin(to_string(random_uuid()));
  unknown["shape"] = "star";
  work = session->on_text(unknown.dump());
  ASSERT_TRUE(work);
  work();
  ASSERT_EQ(socket->of("problem").size(), 1u);
  EXPECT_EQ(socket->of("problem")[0]["field"], "shape");
  EXPECT_EQ(socket->of("problem")[0]["ref"], unknown["id"]);

  json edit = {{"op", "edit"}, {"id", to_string(random_uuid())}, {"layer", "cracks"}};
  edit["edit"] = {{"op", "stroke"}, {"value", 1},  {"camera", camera_json()},
                  {"radius_px", 3}, {"shape", 12}, {"path", {{1, 1}}}};
  work = session->on_text(edit.dump());
  ASSERT_TRUE(work);
  work();
  ASSERT_EQ(room->edits_.held.size(), 2u);
  EXPECT_EQ(room->edits_.held[1].request.record["shape"], 12);
}

TEST_F(Live, what_concerns_the_site_is_told_to_those_who_were_welcomed) {
  protocol::ToolEvent gone;
  gone.event = protocol::ToolEventEvent::deleted;
  gone.tool_id = 4;
  session->tell(gone);
  EXPECT_TRUE(socket->sent.empty());
  hello();
  session->tell(gone);
  ASSERT_EQ(socket->of("tool").size(), 1u);
  EXPECT_EQ(socket->of("tool")[0]["tool_id"], 4);
}

TEST_F(Live, a_deleted_model_is_told_before_the_connection_ends) {
  hello();
  session->model_deleted();
  ASSERT_EQ(socket->of("model").size(), 1u);
  EXPECT_EQ(socket->of("model")[0]["event"], "deleted");
  EXPECT_EQ(socket->close_code, kCloseGoingAway);
}

TEST_F(Live, a_model_that_moved_is_told_with_the_address_before_the_connection_ends) {
  hello();
  session->moved("https://museum.example/node/b");
  ASSERT_EQ(socket->of("moved").size(), 1u);
  EXPECT_EQ(socket->of("moved")[0]["url"], "https://museum.example/node/b");
  EXPECT_EQ(socket->sent.back()["op"], "moved");
  EXPECT_EQ(socket->close_code, kCloseMoved);
}

TEST_F(Live, a_model_that_moved_nobody_knows_where_has_no_address) {
  hello();
  session->moved({});
  ASSERT_EQ(socket->of("moved").size(), 1u);
  EXPECT_FALSE(socket->of("moved")[0].contains("url"));
  EXPECT_EQ(socket->close_code, kCloseMoved);
}

TEST_F(Live, a_database_that_is_lost_and_back_is_told_and_the_connection_stays) {
  hello();
  session->database_reachable(false);
  session->database_reachable(true);
  ASSERT_EQ(socket->of("database").size(), 2u);
  EXPECT_EQ(socket->of("database")[0]["reachable"], false);
  EXPECT_EQ(socket->of("database")[1]["reachable"], true);
  EXPECT_EQ(socket->close_code, 0);
}

TEST_F(Live, an_edit_that_another_node_must_do_is_unsaved_and_not_refused) {
  hello();
  say(begin(stroke));
  const json batch = extend(stroke, 0, {{1, 1}});
  say(batch);
  room->edits_.held[0].saved(tl::unexpected(moved_to("https://museum.example/node/b")));
  ASSERT_EQ(socket->of("unsaved").size(), 1u);
  EXPECT_EQ(socket->of("unsaved")[0]["ids"], json::array({batch["id"]}));
  EXPECT_TRUE(socket->of("problem").empty());
  EXPECT_EQ(shared->metrics->edits.refused, 0u);
}

TEST_F(Live, a_view_that_cannot_be_drawn_is_a_problem) {
  hello();
  session->view_refused(
      2, {ErrorCode::invalid, "Palette not usable", "A palette has points.", "layers"});
  ASSERT_EQ(socket->of("problem").size(), 1u);
  EXPECT_EQ(socket->of("problem")[0]["status"], 422);
}

TEST_F(Live, every_message_it_sends_keeps_the_contract) {
  hello();
  say(begin(stroke));
  say(extend(stroke, 0, {{1, 1}}));
  room->edits_.held.at(0).applied({5, 10, 0.5, false});
  room->edits_.held.at(0).saved(room::EditAnswer{5, 10, 0.5, false});
  say({{"op", "nonsense"}});
  session->layer_changed(room::Listener::LayerChange::created, room->layers().all()[0]);
  session->layer_changed(room::Listener::LayerChange::deleted, room->layers().all()[0]);
  while (!socket->later.empty()) {
    auto work = std::move(socket->later.front());
    socket->later.pop_front();
    work();
  }
  EXPECT_EQ(socket->of("presence").size(), 1u);
  for (const auto& message : socket->sent) {
    // The model of the welcome message is invented and has no valid bounds.
    if (message["op"] == "welcome") continue;
    const auto parsed = protocol::parse_server_message(message.dump());
    EXPECT_TRUE(parsed) << message.dump() << "\n" << (parsed ? "" : parsed.error().detail);
  }
}

TEST_F(Live, hello_comes_first_and_once) {
  say({{"op", "undo"}, {"id", to_string(random_uuid())}, {"layer", "cracks"}});
  ASSERT_EQ(socket->of("problem").size(), 1u);
  EXPECT_EQ(socket->of("problem")[0]["status"], 409);
  hello();
  ASSERT_EQ(socket->of("welcome").size(), 1u);
  const json welcome = socket->of("welcome")[0];
  EXPECT_EQ(welcome["role"], "owner");
  EXPECT_EQ(welcome["layers"][0]["slug"], "cracks");
  EXPECT_EQ(welcome["model"]["project"], "default");
  hello();
  EXPECT_EQ(socket->of("welcome").size(), 1u);
  EXPECT_EQ(socket->of("problem").size(), 2u);
}

TEST_F(Live, the_room_hears_who_edits_and_what_they_may) {
  connect(Role::annotator);
  hello();
  say(begin(stroke));
  say(extend(stroke, 0, {{1, 1}}));
  for (const char* op : {"undo", "redo"})
    say({{"op", op}, {"id", to_string(random_uuid())}, {"layer", "cracks"}});
  const json fill = {{"op", "fill"}, {"value", 1}, {"mode", "where"}, {"where", "true"}};
  say({{"op", "edit"}, {"id", to_string(random_uuid())}, {"layer", "cracks"}, {"edit", fill}});
  ASSERT_EQ(room->edits_.held.size(), 4u);
  for (const auto& edit : room->edits_.held) {
    EXPECT_EQ(edit.request.author.user, "anna");
    EXPECT_EQ(edit.request.author.role, Role::annotator);
  }
}

TEST_F(Live, a_kiosk_looks_and_hears_of_nobody_and_nobody_of_it) {
  const auto screens_socket = std::make_shared<FakeSocket>();
  Principal kiosk{kiosk_name(3), Role::viewer};
  kiosk.kiosk = KioskPass{3, 1, 2};
  auto screen = std::make_shared<LiveSession>(shared, room, "default", kiosk, room::Portrait(),
                                              std::nullopt, screens_socket);
  shared->sockets->add(screens_socket, screen, "link");
  screen->on_text(json{{"op", "hello"}}.dump());
  ASSERT_EQ(screens_socket->of("welcome").size(), 1u);
  EXPECT_TRUE(screens_socket->later.empty()) << "presence is not even scheduled";
  hello();

  const std::vector<json> refused{
      begin(stroke),
      extend(stroke, 0, {{1, 1}}),
      {{"op", "undo"}, {"id", to_string(random_uuid())}, {"layer", "cracks"}},
      {{"op", "presence"}, {"pointer", {1, 1}}},
      {{"op", "record.edit"}, {"table", 4}, {"key", 7}, {"editing", true}}};
  for (const json& message : refused) EXPECT_FALSE(screen->on_text(message.dump()));
  ASSERT_EQ(screens_socket->of("problem").size(), refused.size());
  for (const json& problem : screens_socket->of("problem")) EXPECT_EQ(problem["status"], 403);
  EXPECT_TRUE(room->edits_.held.empty());

  room::Listener::Edit edit;
  edit.id = random_uuid();
  edit.layer_id = 7;
  edit.user = "anna";
  edit.review = {Decision::reject, "Too wide", {"bea"}};
  screen->edit_applied(edit);
  ASSERT_EQ(screens_socket->of("layer").size(), 1u);
  EXPECT_FALSE(screens_socket->of("layer")[0].contains("user"));
  EXPECT_FALSE(screens_socket->of("layer")[0].contains("review"));
  edit.id = random_uuid();
  session->edit_applied(edit);
  EXPECT_EQ(socket->of("layer").back()["review"],
            (json{{"decision", "reject"}, {"reason", "Too wide"}, {"authors", {"bea"}}}));
  edit_record(*session, 7, true);
  EXPECT_TRUE(screens_socket->of("record.editors").empty());
  EXPECT_FALSE(socket->of("record.editors").empty());

  room->participants_.people = {{random_uuid(), kiosk.user, "", "#112233"},
                                {random_uuid(), "bea", "", "#112233"}};
  session->presence_changed();
  for (auto work = std::exchange(socket->later, {}); const auto& each : work) each();
  const json users = socket->of("presence").back()["users"];
  ASSERT_EQ(users.size(), 1u);
  EXPECT_EQ(users[0]["name"], "bea");
  screen->on_closed();
}

TEST_F(Live, who_writes_into_a_record_is_told_to_all_of_the_project) {
  hello();
  const auto others_socket = std::make_shared<FakeSocket>();
  auto other =
      std::make_shared<LiveSession>(shared, room, "default", Principal{"bea", Role::annotator},
                                    room::Portrait{"Bea"}, std::nullopt, others_socket);
  shared->sockets->add(others_socket, other, "other");
  edit_record(*session, 7, true);
  edit_record(*session, 8, true);
  ASSERT_EQ(socket->of("record.editors").size(), 2u);
  EXPECT_TRUE(others_socket->sent.empty()) << "not welcomed yet";
  other->on_text(json{{"op", "hello"}}.dump());
  const json own = socket->of("welcome")[0]["session"],
             others = others_socket->of("welcome")[0]["session"];
  const json has_7{{"table", 4}, {"key", 7}, {"session", own}, {"user", "anna"}};
  EXPECT_EQ(socket->of("record.editors")[0]["records"], json::array({has_7}));
  ASSERT_EQ(others_socket->of("record.editors").size(), 1u);
  EXPECT_EQ(others_socket->of("record.editors")[0]["records"].size(), 2u) << "all that there are";

  edit_record(*other, 7, true);  // anna is editing it
  EXPECT_EQ(others_socket->of("record.editors").size(), 1u);
  edit_record(*other, 7, true, {{"take_over", true}});
  const json taken{{"table", 4}, {"key", 7}, {"session", others}, {"user", "bea"}};
  for (const auto& hears : {socket, others_socket})
    EXPECT_EQ(hears->of("record.editors").back()["records"], json::array({taken}));
  edit_record(*session, 7, false);  // ends anna's edit
  EXPECT_EQ(socket->of("record.editors").back()["records"], json::array({taken}));
  edit_record(*session, 8, false);
  EXPECT_EQ(others_socket->of("record.editors").back()["records"],
            json::parse(R"([{"table": 4, "key": 8}])"));
  other->on_closed();
  EXPECT_EQ(socket->of("record.editors").back()["records"],
            json::parse(R"([{"table": 4, "key": 7}])"));
  for (const auto& message : socket->of("record.editors"))
    EXPECT_TRUE(protocol::parse_server_message(message.dump())) << message;
}

TEST_F(Live, a_record_that_is_not_there_and_a_viewer_are_refused) {
  hello();
  edit_record(*session, 7, true, {{"table", 5}, {"id", "mine"}});
  ASSERT_EQ(socket->of("problem").size(), 1u);
  EXPECT_EQ(socket->of("problem")[0]["status"], 404);
  EXPECT_EQ(socket->of("problem")[0]["ref"], "mine");
  EXPECT_EQ(socket->of("problem")[0]["field"], "table");
  connect(Role::viewer);
  hello();
  say({{"op", "record.edit"}, {"id", "mine"}, {"table", 4}, {"key", 7}, {"editing", true}});
  ASSERT_EQ(socket->of("problem").size(), 1u);
  EXPECT_EQ(socket->of("problem")[0]["status"], 403);
  EXPECT_EQ(socket->of("problem")[0]["ref"], "mine");
  EXPECT_TRUE(socket->of("record.editors").empty());
}

TEST_F(Live, a_stroke_is_applied_then_saved_under_its_number) {
  hello();
  say(begin(stroke));
  say(extend(stroke, 0, {{1, 1}, {2, 2}}));
  say(extend(stroke, 1, {{3, 3}}));
  ASSERT_EQ(room->edits_.held.size(), 2u);
  const auto& second = std::get<room::StrokeEdit>(room->edits_.held[1].request.edit);
  EXPECT_EQ(second.n, 1);
  EXPECT_EQ(second.batch.path, (std::vector<glm::dvec2>{{2, 2}, {3, 3}}));
  EXPECT_TRUE(socket->of("applied").empty());
  room->edits_.held[0].applied({1, 4, 0.1, false});
  ASSERT_EQ(socket->of("applied").size(), 1u);
  EXPECT_EQ(socket->of("applied")[0]["stroke"], stroke);
  EXPECT_EQ(socket->of("applied")[0]["n"], 0);
  EXPECT_TRUE(socket->of("saved").empty());
  room->edits_.held[0].saved(room::EditAnswer{1, 4, 0.1, false});
  ASSERT_EQ(socket->of("saved").size(), 1u);
  EXPECT_EQ(socket->of("saved")[0]["sequence"], 1);
  EXPECT_EQ(shared->metrics->edits.saved, 1u);
}

TEST_F(Live, after_a_reconnect_the_resent_batch_is_joined_as_before) {
  hello();
  const json first_begin = begin(stroke);
  const json batch0 = extend(stroke, 0, {{1, 1}}), batch1 = extend(stroke, 1, {{2, 2}});
  say(first_begin);
  say(batch0);
  say(batch1);
  room->edits_.held[0].applied({1, 1, 0, false});
  room->edits_.held[0].saved(room::EditAnswer{1, 1, 0, false});

  connect();
  hello();
  const json strokes = socket->of("welcome")[0]["strokes"];
  ASSERT_EQ(strokes.size(), 1u);
  EXPECT_EQ(strokes[0], json({{"stroke", stroke}, {"n", 0}}));
  say(first_begin);
  say(batch1);
  say(extend(stroke, 2, {{3, 3}}));
  EXPECT_TRUE(socket->of("problem").empty());
  ASSERT_EQ(room->edits_.held.size(), 4u);
  EXPECT_EQ(room->edits_.held[2].request.id, room->edits_.held[1].request.id);
  EXPECT_EQ(std::get<room::StrokeEdit>(room->edits_.held[2].request.edit).batch.path,
            (std::vector<glm::dvec2>{{1, 1}, {2, 2}}));
  EXPECT_EQ(std::get<room::StrokeEdit>(room->edits_.held[3].request.edit).batch.path,
            (std::vector<glm::dvec2>{{2, 2}, {3, 3}}));
}

TEST_F(Live, a_save_that_ends_after_the_connection_counts_for_the_next) {
  hello();
  say(begin(stroke));
  say(extend(stroke, 0, {{1, 1}}));
  connect();
  room->edits_.held[0].applied({1, 1, 0, false});
  room->edits_.held[0].saved(room::EditAnswer{1, 1, 0, false});
  EXPECT_TRUE(socket->of("saved").empty());
  hello();
  EXPECT_EQ(socket->of("welcome")[0]["strokes"][0]["n"], 0);
}

TEST_F(Live, an_edit_that_is_taken_back_is_told_as_unsaved) {
  hello();
  say(begin(stroke));
  const json batch = extend(stroke, 0, {{1, 1}});
  say(batch);
  room->edits_.held[0].applied({1, 1, 0, false});
  room->edits_.held[0].saved(fail(ErrorCode::unavailable, "Not saved", "The database is away."));
  ASSERT_EQ(socket->of("unsaved").size(), 1u);
  EXPECT_EQ(socket->of("unsaved")[0]["ids"], json::array({batch["id"]}));
  EXPECT_TRUE(socket->of("problem").empty());
}

TEST_F(Live, an_edit_that_is_refused_is_a_problem_with_its_id) {
  hello();
  const std::string id = to_string(random_uuid());
  say({{"op", "edit"},
       {"id", id},
       {"layer", 7},
       {"edit", {{"op", "fill"}, {"mode", "where"}, {"where", "true"}, {"value", 1}}}});
  ASSERT_EQ(room->edits_.held.size(), 1u);
  room->edits_.held[0].saved(fail(ErrorCode::too_many_requests, "Too many edits", "Wait."));
  ASSERT_EQ(socket->of("problem").size(), 1u);
  EXPECT_EQ(socket->of("problem")[0]["ref"], id);
  EXPECT_EQ(socket->of("problem")[0]["status"], 429);
  EXPECT_EQ(shared->metrics->edits.refused, 1u);
}

TEST_F(Live, others_hear_that_the_layer_was_edited_and_the_author_does_not) {
  hello();
  say(begin(stroke));
  say(extend(stroke, 0, {{1, 1}}));
  room::Listener::Edit own;
  own.layer_id = 7;
  own.id = room->edits_.held[0].request.id;
  own.user = "anna";
  own.sequence = 1;
  session->edit_applied(own);
  EXPECT_TRUE(socket->of("layer").empty());
  room::Listener::Edit foreign = own;
  foreign.id = random_uuid();
  foreign.user = "bert";
  foreign.sequence = 2;
  session->edit_applied(foreign);
  ASSERT_EQ(socket->of("layer").size(), 1u);
  EXPECT_EQ(socket->of("layer")[0]["event"], "edited");
  EXPECT_EQ(socket->of("layer")[0]["sequence"], 2);
  EXPECT_EQ(socket->of("layer")[0]["user"], "bert");
}

TEST_F(Live, with_many_people_the_edits_of_a_layer_are_told_together) {
  shared->limits.presence_every = std::chrono::hours(1);
  hello();
  room->participants_.people.resize(40, room->participants_.people[0]);
  socket->later.front()();  // sends the presence, so the session has 40 people
  socket->delays.clear();
  std::int64_t sequence = 0;
  const auto edit = [&](std::int64_t layer, bool provisional = false) {
    room::Listener::Edit foreign;
    foreign.layer_id = LayerId(layer);
    foreign.id = random_uuid();
    foreign.user = "bert";
    foreign.sequence = ++sequence;
    foreign.answer.provisional = provisional;
    return foreign;
  };
  session->edit_applied(edit(7));
  ASSERT_EQ(socket->of("layer").size(), 1u) << "the first one comes at once";
  session->edit_applied(edit(7, true));
  session->edit_applied(edit(8));
  session->edit_applied(edit(7));
  EXPECT_EQ(socket->of("layer").size(), 1u);
  ASSERT_EQ(socket->delays.size(), 1u);
  EXPECT_GT(socket->delays[0], std::chrono::hours(4)) << "as rarely as presence";
  socket->later.back()();
  auto told = socket->of("layer");
  ASSERT_EQ(told.size(), 3u);
  EXPECT_EQ(told[1]["layer_id"], 8) << "in the order of the sequences";
  EXPECT_EQ(told[1]["sequence"], 3);
  EXPECT_EQ(told[2]["layer_id"], 7);
  EXPECT_EQ(told[2]["sequence"], 4);
  EXPECT_EQ(told[2]["provisional"], true) << "one of the edits waits for review";
  // A decision of a curator is a message of its own. The waiting edits precede it, those of each
  // user by themselves.
  auto carls = edit(7);
  carls.user = "carl";
  session->edit_applied(carls);
  session->edit_applied(edit(7));
  auto decision = edit(7);
  decision.review.emplace();
  session->edit_applied(decision);
  told = socket->of("layer");
  ASSERT_EQ(told.size(), 6u);
  EXPECT_EQ(told[3]["user"], "carl");
  EXPECT_EQ(told[3]["sequence"], 5);
  EXPECT_EQ(told[4]["user"], "bert");
  EXPECT_EQ(told[4]["sequence"], 6);
  EXPECT_EQ(told[5]["sequence"], 7);
  // The same holds if edits are rolled back.
  session->edit_applied(edit(8));
  auto unsaved = edit(8);
  unsaved.sequence = 3;
  session->edits_unsaved({unsaved}, {});
  socket->later.back()();
  told = socket->of("layer");
  ASSERT_EQ(told.size(), 8u);
  EXPECT_EQ(told[6]["sequence"], 8);
  EXPECT_EQ(told[7]["sequence"], 3);
}

TEST_F(Live, bad_messages_name_the_field_and_the_connection_lives_on) {
  hello();
  json wrong = begin(stroke);
  wrong["value"] = 400;  // too large for a u8 layer
  say(wrong);
  wrong["value"] = 3;
  wrong["layer"] = "nothing";
  say(wrong);
  say(extend(stroke, 0, {{1, 1}}));  // this stroke was never begun
  EXPECT_FALSE(session->on_text("{"));
  session->on_binary();
  json singular = {{"op", "camera"}, {"seq", 1}};
  singular.update(camera_json());
  singular["view"] = json(std::vector<int>(16, 0));
  say(singular);
  const auto problems = socket->of("problem");
  ASSERT_EQ(problems.size(), 6u);
  EXPECT_EQ(problems[0]["field"], "value");
  EXPECT_EQ(problems[0]["ref"], wrong["id"]);
  EXPECT_EQ(problems[1]["field"], "layer");
  EXPECT_EQ(problems[2]["field"], "stroke");
  EXPECT_EQ(problems[3]["status"], 400);
  EXPECT_EQ(problems[4]["status"], 415);
  EXPECT_EQ(problems[5]["field"], "view");
  EXPECT_TRUE(room->edits_.held.empty());
  EXPECT_EQ(socket->close_code, 0);
}

TEST_F(Live, a_viewer_may_look_but_not_paint) {
  connect(Role::viewer);
  hello();
  say(begin(stroke));
  say({{"op", "undo"}, {"id", to_string(random_uuid())}, {"layer", "cracks"}});
  const auto problems = socket->of("problem");
  ASSERT_EQ(problems.size(), 2u);
  EXPECT_EQ(problems[0]["status"], 403);
  EXPECT_TRUE(room->edits_.held.empty());
}

TEST_F(Live, who_looks_at_the_past_may_not_paint) {
  connect();
  hello();
  say({{"op", "layers"}, {"layers", nlohmann::json::array()}, {"at", 0}});
  EXPECT_EQ(room->participants_.newest->shown.at(0).at, 0);
  say(begin(stroke));
  say({{"op", "undo"}, {"id", to_string(random_uuid())}, {"layer", "cracks"}});
  const auto problems = socket->of("problem");
  ASSERT_EQ(problems.size(), 2u);
  EXPECT_EQ(problems[0]["status"], 409);
  EXPECT_TRUE(room->edits_.held.empty());
  // Another view may show an earlier state next to the newest one.
  say({{"op", "layers"}, {"layers", nlohmann::json::array()}});
  say({{"op", "layers"}, {"view_id", 1}, {"layers", nlohmann::json::array()}, {"at", 0}});
  say({{"op", "undo"}, {"id", to_string(random_uuid())}, {"layer", "cracks"}});
  EXPECT_EQ(socket->of("problem").size(), 2u);
  say({{"op", "layers"}, {"layers", nlohmann::json::array()}, {"at", 1000000}});
  EXPECT_EQ(socket->of("problem").at(2)["field"], "at");
}

TEST_F(Live, too_many_messages_are_refused_and_abuse_ends_the_connection) {
  shared->limits.messages_per_second = 0.001;
  shared->limits.burst = 2;
  shared->limits.max_refusals = 3;
  connect();
  hello();
  for (int i = 0; i < 4; ++i) say({{"op", "ack"}, {"frame", i}});
  EXPECT_EQ(socket->of("problem").size(), 3u);
  EXPECT_EQ(socket->of("problem")[0]["status"], 429);
  EXPECT_EQ(socket->close_code, 0);
  say({{"op", "ack"}, {"frame", 9}});
  EXPECT_EQ(socket->close_code, kClosePolicy);
}

TEST_F(Live, presence_is_told_once_for_many_changes) {
  hello();
  for (int i = 0; i < 100; ++i) session->presence_changed();
  ASSERT_EQ(socket->later.size(), 1u);
  socket->later.front()();
  ASSERT_EQ(socket->of("presence").size(), 1u);
  EXPECT_EQ(socket->of("presence")[0]["users"][0]["pointer"]["position"], json({1.0, 2.0, 3.0}));
  session->presence_changed();
  EXPECT_EQ(socket->later.size(), 2u);
}

TEST_F(Live, presence_tells_of_each_what_the_room_knows_and_nothing_else) {
  hello();
  ASSERT_EQ(room->participants_.portraits.size(), 1U);
  EXPECT_EQ(room->participants_.portraits.front().full_name, "Anna Ost");
  const Uuid leader = random_uuid(), follower = room->participants_.newest->session();
  Camera seen;
  seen.width = 640;
  seen.height = 480;
  room->participants_.people = {
      {follower, "anna", "Anna Ost", "#112233", {}, false, leader, {}},
      {leader, "bea", "", "#445566", room::Pointing{{1, 2, 3}, 0.5}, true, {}, seen}};
  socket->later.front()();
  const json users = socket->of("presence").at(0)["users"];
  EXPECT_EQ(users[0], (json{{"session", to_string(follower)},
                            {"name", "anna"},
                            {"full_name", "Anna Ost"},
                            {"color", "#112233"},
                            {"leading", false},
                            {"following", to_string(leader)}}));
  EXPECT_EQ(users[1]["pointer"], (json{{"position", {1.0, 2.0, 3.0}}, {"radius", 0.5}}));
  EXPECT_EQ(users[1]["leading"], true);
  EXPECT_EQ(users[1]["camera"]["width"], 640);
  EXPECT_FALSE(users[1].contains("full_name"));
  EXPECT_TRUE(protocol::parse_server_message(socket->of("presence")[0].dump()));
}

TEST_F(Live, presence_comes_the_less_often_the_more_people_are_here) {
  shared->limits.presence_every = std::chrono::hours(1);
  hello();
  room->participants_.people.resize(40, room->participants_.people[0]);
  socket->later.front()();
  session->presence_changed();
  ASSERT_EQ(socket->delays.size(), 2u);
  EXPECT_EQ(socket->delays[0].count(), 0);
  EXPECT_GT(socket->delays[1], std::chrono::hours(4)) << "five times eight people";
  EXPECT_LE(socket->delays[1], std::chrono::hours(5));
}

TEST_F(Live, what_a_viewer_shows_of_themselves_is_refused_as_a_whole) {
  hello();
  const Uuid bea = random_uuid();
  say({{"op", "presence"}, {"leading", true}, {"follow", to_string(bea)}});
  say({{"op", "presence"}, {"leading", true}, {"follow", to_string(FakeParticipant::kGone)}});
  say({{"op", "presence"}, {"radius", -1}});
  say({{"op", "presence"}, {"follow", nullptr}});
  ASSERT_EQ(socket->of("problem").size(), 2u);
  EXPECT_EQ(socket->of("problem")[0]["status"], 404);
  EXPECT_EQ(socket->of("problem")[0]["field"], "follow");
  EXPECT_EQ(socket->of("problem")[1]["field"], "radius");
  using Said = std::vector<std::pair<bool, std::optional<Uuid>>>;
  EXPECT_EQ(room->participants_.newest->together, (Said{{true, bea}, {false, std::nullopt}}));
  EXPECT_EQ(room->participants_.newest->pointers.size(), 2u);
}

TEST_F(Live, the_brush_in_hand_is_told_with_the_place_that_it_points_at) {
  room->queries_.found.hit = true;
  room->queries_.found.position = {4, 5, 6};
  hello();
  json camera = camera_json();
  camera["op"] = "camera";
  camera["seq"] = 1;
  say(camera);
  say({{"op", "presence"}, {"pointer", {10, 20}}, {"radius", 2.5}});
  shared->queries.reset();  // completes the pending query
  ASSERT_EQ(room->participants_.newest->pointers.size(), 1u);
  ASSERT_TRUE(room->participants_.newest->pointers[0]);
  EXPECT_EQ(room->participants_.newest->pointers[0]->position, glm::dvec3(4, 5, 6));
  EXPECT_EQ(room->participants_.newest->pointers[0]->radius, 2.5);
}

TEST_F(Live, a_client_that_draws_no_jpeg_is_told) {
  say({{"op", "hello"}, {"accept", {"av1"}}});
  ASSERT_EQ(socket->of("problem").size(), 1u);
  EXPECT_EQ(socket->of("problem")[0]["field"], "accept");
}

TEST_F(Live, frames_are_counted_and_stop_with_the_socket) {
  hello();
  const auto message = std::make_shared<const std::vector<std::uint8_t>>(100);
  room->participants_.sends.at(0)({message, message});  // two rectangles
  EXPECT_EQ(socket->frames.size(), 2u);
  EXPECT_EQ(shared->metrics->frames_sent, 1u);
  EXPECT_EQ(shared->metrics->frame_bytes_sent, 200u);
  session->on_closed();
  session.reset();
  socket.reset();
  room->participants_.sends.at(0)({message});  // a late encoder
}

TEST_F(Live, after_a_restart_the_batch_before_is_looked_up_off_the_socket_thread) {
  hello();
  say(begin(stroke));
  EXPECT_TRUE(session->on_text(extend(stroke, 4, {{1, 1}}).dump()))
      << "work for a worker, before the next message is read";
  EXPECT_TRUE(room->edits_.held.empty());
}

}  // namespace
}  // namespace strata::net
