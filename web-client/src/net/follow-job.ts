// Follows a job on the server until it ends.

import { ApiError } from "./api-error";
import type { Api } from "./api";
import type { Job } from "../core/types";

const kPollMs = 400;
const kLongestPollMs = 5000;
// enough for some minutes, because a restarted server still reports the job's result
const kMostFailedPolls = 60;

export const jobIsOver = (job: Job): boolean => job.state !== "queued" && job.state !== "running";

/**
 * Calls `tell` with each state of the job, and returns the last state. Retries while the server is
 * temporarily unreachable.
 */
export async function followJob(api: Api, first: Job, tell: (job: Job) => void): Promise<Job> {
  let job = first;
  let failedPolls = 0;
  for (;;) {
    tell(job);
    if (jobIsOver(job)) return job;
    const pauseMs = Math.min(kPollMs * 1.5 ** failedPolls, kLongestPollMs);
    await new Promise((resolve) => setTimeout(resolve, pauseMs));
    try {
      job = await api.json("GET /jobs/{job}", { path: { job: job.id } });
      failedPolls = 0;
    } catch (error) {
      const passing =
        error instanceof ApiError &&
        (error.status === 0 || error.status >= 500 || error.status === 429);
      if (!passing || ++failedPolls > kMostFailedPolls) throw error;
    }
  }
}
