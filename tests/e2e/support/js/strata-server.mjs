// A separate Strata server for a test in JavaScript. strata_server.py is the equivalent in Python.
import { execFileSync, spawn } from "node:child_process";
import { randomBytes } from "node:crypto";
import {
  chmodSync,
  existsSync,
  mkdtempSync,
  readdirSync,
  readFileSync,
  rmSync,
  statfsSync,
} from "node:fs";
import { join } from "node:path";
import { createInterface } from "node:readline";

export const kLong_ms = 120_000;

const kOften = ["--recheck-every", "1"]; // tests do not wait for the default interval
const kInMemory = "/dev/shm";
// enough for several concurrent tests, one of which writes gigabytes
const kRoom_bytes = 8 * 2 ** 30;

/** Returns a folder in memory if there is space, because a disk is slow for a database. */
function place_of_data() {
  if (process.env.STRATA_TEST_TMP) return process.env.STRATA_TEST_TMP;
  if (!existsSync(kInMemory)) return "/tmp";
  const { bavail, bsize } = statfsSync(kInMemory);
  return bavail * bsize > kRoom_bytes ? kInMemory : "/tmp";
}

export async function wait_for(condition, what, every_ms = 50) {
  const end = Date.now() + kLong_ms;
  for (;;) {
    const found = await condition();
    if (found) return found;
    if (Date.now() > end) throw new Error(`waited ${kLong_ms / 1000} s for ${what}`);
    await new Promise((resolve) => setTimeout(resolve, every_ms));
  }
}

export class StrataServer {
  /** `env` contains additional environment variables of this server. */
  constructor({ demo = false, env = {} } = {}) {
    this.binary = process.env.STRATA_BINARY;
    if (!this.binary) throw new Error("STRATA_BINARY names the server");
    this.token = randomBytes(24).toString("hex");
    // The folder is open to all users. PostgreSQL does not run as root, so its user needs access.
    this.data = mkdtempSync(join(place_of_data(), "strata-e2e-"));
    chmodSync(this.data, 0o755);
    this.log = [];
    this.port = 0;
    process.on("exit", () => this.process?.kill("SIGKILL"));
    this.demo = demo;
    this.env = env;
  }

  /** Copies the result of tests/support/prepare, or makes the data if that script did not run. */
  #fill() {
    if (readdirSync(this.data).length > 0) return; // the server starts again
    const prepared = process.env.STRATA_TEST_PREPARED;
    if (prepared) {
      // copies owners and modes, because PostgreSQL requires both
      execFileSync("cp", ["-a", `${prepared}/${this.demo ? "demo" : "empty"}/.`, this.data]);
    } else if (this.demo) {
      execFileSync(this.binary, ["demo", "--pot-only", "--data", this.data], {
        stdio: ["ignore", "ignore", "pipe"],
      });
    }
  }

  /** Starts the server and returns when it listens. A later start uses the same port. */
  async start() {
    this.#fill();
    this.process = spawn(
      this.binary,
      ["serve", "--data", this.data, "--listen", `127.0.0.1:${this.port}`, ...kOften],
      {
        env: {
          STRATA_SAMPLES_AT_REST: "1", // frames at rest always have the same pixels
          ...process.env,
          ...this.env,
          STRATA_OWNER_TOKEN: this.token,
        },
        stdio: ["ignore", "pipe", "pipe"],
      },
    );
    this.ended = new Promise((resolve) =>
      this.process.once("exit", (code, signal) => resolve(code ?? signal)),
    );
    createInterface({ input: this.process.stderr }).on("line", (line) => this.log.push(line));
    const started = new Promise((resolve) => {
      createInterface({ input: this.process.stdout }).on("line", (line) => {
        if (line.startsWith("listening on ")) this.url = line.split(" ").at(-1);
        if (/^(owner link|sign in at): /.test(line)) resolve((this.link = line.split(" ").at(-1)));
      });
    });
    const early = await Promise.race([started, this.ended]);
    if (early !== this.link)
      throw new Error(`the server ended with ${early}:\n${this.log.slice(-50).join("\n")}`);
    this.port = Number(new URL(this.url).port);
    return this;
  }

  end_of_log() {
    return this.log.slice(-200).join("\n");
  }

  /** `SIGSTOP` freezes the server, and `SIGKILL` ends it without warning. */
  async signal(name) {
    this.process.kill(name);
    if (name === "SIGKILL" || name === "SIGTERM") return this.ended;
  }

  postmaster_runs() {
    const file = join(this.data, "postgres", "pgdata", "postmaster.pid");
    return existsSync(file) && existsSync(`/proc/${parseInt(readFileSync(file, "latin1"), 10)}`);
  }

  async remove() {
    if (this.process?.exitCode === null && this.process.signalCode === null)
      await this.signal("SIGKILL");
    await wait_for(() => !this.postmaster_runs(), "the private PostgreSQL to end");
    rmSync(this.data, { recursive: true, force: true });
  }

  /**
   * Checks that the log has no errors. Warnings are allowed if they contain one of the words, about
   * a fault that the test caused.
   */
  assert_clean_log(words = []) {
    const bad = this.log.filter((line) => {
      const level = line.split(" ")[1];
      return !(
        ["I", "D"].includes(level) ||
        (level === "W" && words.some((word) => line.includes(word)))
      );
    });
    if (bad.length > 0)
      throw new Error(`the log of the server is not clean:\n${bad.slice(0, 50).join("\n")}`);
  }

  /**
   * Returns the secret for a request as the owner: the token or, for accounts, a session. Tokens
   * for scripts cannot change accounts. The owner's token has the same limit once an
   * administrator has a password.
   */
  async owners_secret(path) {
    if (!/^\/(users|groups|me\/)|^\/projects\/[^/]+\/(members|groups)(\/|$)|\/kiosks$/.test(path))
      return this.token;
    if (!this.session) await this.sign_in_owner({ token: this.token });
    return this.session;
  }
  async sign_in_owner(login, tries = 3) {
    const answer = await fetch(`${this.url}/api/v1/login`, {
      method: "POST",
      headers: { "Content-Type": "application/json", Origin: this.url },
      body: JSON.stringify(login),
    });
    // another call at the same time can end all other sessions of the owner, also the new one
    if (answer.status === 401 && tries > 1) return this.sign_in_owner(login, tries - 1);
    if (!answer.ok) throw new Error(`the owner's sign-in: ${answer.status} ${await answer.text()}`);
    this.session = answer.headers.get("set-cookie").split(";")[0].split("=")[1];
  }

  /** Adds a user with the secrets to sign in, and with a token for scripts. */
  async add_person(user, role) {
    const password = `${user} and seven blue herons`;
    const invitation = (await this.json("POST", "/users", { user, role })).path.split("#")[1];
    const post = (path, body, headers = {}) =>
      fetch(`${this.url}/api/v1${path}`, {
        method: "POST",
        headers: { "Content-Type": "application/json", Origin: this.url, ...headers },
        body: JSON.stringify(body),
      });
    const joined = await post("/invitations/accept", { invitation, password });
    if (!joined.ok) throw new Error(`joining: ${joined.status} ${await joined.text()}`);
    const made = await post(
      "/me/tokens",
      { name: "tests" },
      { Cookie: joined.headers.get("set-cookie").split(";")[0] },
    );
    if (!made.ok) throw new Error(`a token: ${made.status} ${await made.text()}`);
    return { user, password, token: (await made.json()).secret };
  }

  /** Replaces the owner's session if a tested request has ended it. */
  async request(method, path, body, headers = {}, tries = 5) {
    const secret = await this.owners_secret(path);
    const answer = await fetch(`${this.url}/api/v1${path}`, {
      method,
      headers: {
        Authorization: `Bearer ${secret}`,
        ...(body === undefined ? {} : { "Content-Type": "application/json" }),
        ...headers,
      },
      ...(body === undefined ? {} : { body: JSON.stringify(body) }),
    });
    if (answer.status === 401 && secret !== this.token && tries > 1) {
      if (this.session === secret) this.session = undefined;
      return this.request(method, path, body, headers, tries - 1);
    }
    if (!answer.ok) throw new Error(`${method} ${path}: ${answer.status} ${await answer.text()}`);
    return answer;
  }
  async json(method, path, body) {
    return (await this.request(method, path, body)).json();
  }
}
