// Long work on the server, watched until it ends.

import { ApiError, type Api } from "./api";
import type { Job } from "../core/types";

const kPoll_ms = 400;
const kLongestPoll_ms = 5000;
const kMostFailedPolls = 60; // some minutes: a server that restarts answers what became of the job

export const job_is_over = (job: Job): boolean => job.state !== "queued" && job.state !== "running";

/**
 * Tells every state of the job, and returns the last. A server that is away for a moment is asked
 * again.
 */
export async function follow_job(api: Api, first: Job, tell: (job: Job) => void): Promise<Job> {
  let job = first;
  let failed_polls = 0;
  for (;;) {
    tell(job);
    if (job_is_over(job)) return job;
    const pause_ms = Math.min(kPoll_ms * 1.5 ** failed_polls, kLongestPoll_ms);
    await new Promise((resolve) => setTimeout(resolve, pause_ms));
    try {
      job = await api.job(job.id);
      failed_polls = 0;
    } catch (error) {
      const passing =
        error instanceof ApiError &&
        (error.status === 0 || error.status >= 500 || error.status === 429);
      if (!passing || ++failed_polls > kMostFailedPolls) throw error;
    }
  }
}
