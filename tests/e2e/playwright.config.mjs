// Configuration of @playwright/test for the cases in browser/ that use support/js/cases.mjs. CTest
// selects one file. STRATA_TEST_REPORT is the folder of its report, with screenshots of failures.
// With STRATA_TEST_TRACE=1 the folder also contains a trace of each failure. Recording a trace takes
// a third of the processor time of a test, so it is off without this variable.
import { kLong_ms } from "./support/js/strata-server.mjs";

const report = process.env.STRATA_TEST_REPORT;

export default {
  testDir: "browser",
  testMatch: "*_test.mjs",
  workers: 1,
  maxFailures: 1, // cases depend on each other, so the results after a failure have no meaning
  timeout: 5 * kLong_ms,
  reporter: report ? [["list"], ["junit", { outputFile: `${report}.xml` }]] : "list",
  outputDir: report ? `${report}_failures` : undefined,
  use: {
    trace: process.env.STRATA_TEST_TRACE ? "retain-on-failure" : "off",
    screenshot: "only-on-failure",
  },
};
