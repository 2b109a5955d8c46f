// How @playwright/test runs the cases of the files in browser/ that are written for it
// (support/js/cases.mjs). CTest names one file, and with STRATA_TEST_REPORT where its report goes;
// traces and pictures of failures lie beside it.
import { kLong_ms } from "./support/js/strata-server.mjs";

const report = process.env.STRATA_TEST_REPORT;

export default {
  testDir: "browser",
  testMatch: "*_test.mjs",
  workers: 1,
  maxFailures: 1, // the cases of a file tell one story: after a failure the rest tells nothing
  timeout: 5 * kLong_ms,
  reporter: report ? [["list"], ["junit", { outputFile: `${report}.xml` }]] : "list",
  outputDir: report ? `${report}_failures` : undefined,
  use: { trace: "retain-on-failure", screenshot: "only-on-failure" },
};
