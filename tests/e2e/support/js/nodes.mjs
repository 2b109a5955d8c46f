// Three nodes behind nginx for a test in JavaScript. support/serve_nodes.py runs them over one
// PostgreSQL, and support/serve_cluster.py over a cluster of three.
import { spawn } from "node:child_process";
import { join } from "node:path";
import { createInterface } from "node:readline";
import { kRoot } from "./modules.mjs";
import { StrataServer } from "./strata-server.mjs";

export class NodeSite extends StrataServer {
  #answers = []; // lines that no command has taken yet
  #waiting = []; // commands without an answer

  constructor({ program = "serve_nodes.py", ...more } = {}) {
    super(more);
    this.program = join(kRoot, "tests/e2e/support", program);
  }

  async start() {
    this.process = spawn("/usr/bin/python3", [this.program, ...(this.demo ? ["--demo"] : [])], {
      env: process.env,
      stdio: ["pipe", "pipe", "pipe"],
    });
    this.ended = new Promise((resolve) =>
      this.process.once("exit", (code, signal) => {
        for (const { failed } of this.#waiting.splice(0))
          failed(new Error(`the nodes ended with ${code ?? signal}:\n${this.end_of_log()}`));
        resolve(code ?? signal);
      }),
    );
    createInterface({ input: this.process.stderr }).on("line", (line) => this.log.push(line));
    createInterface({ input: this.process.stdout }).on("line", (line) => {
      const waiting = this.#waiting.shift();
      if (waiting) waiting.done(JSON.parse(line));
      else this.#answers.push(JSON.parse(line));
    });
    const { url, token, owner } = await this.#answer();
    this.url = url;
    this.token = token;
    this.owner = owner; // the name and password of the owner, if there is a password
    return this;
  }

  #answer() {
    if (this.#answers.length > 0) return Promise.resolve(this.#answers.shift());
    return new Promise((done, failed) => this.#waiting.push({ done, failed }));
  }

  /** Runs a command of the program, one at a time. */
  async command(...words) {
    this.process.stdin.write(`${words.join(" ")}\n`);
    const answer = await this.#answer();
    if (answer.error) throw new Error(answer.error);
    return answer;
  }

  async remove() {
    if (this.process?.exitCode === null && this.process.signalCode === null) {
      this.process.stdin.end();
      await this.ended;
    }
    await super.remove();
  }
}
