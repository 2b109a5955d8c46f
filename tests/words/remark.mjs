// Checks the links of the documents to each other, to headings and to source files.
import validateLinks from "remark-validate-links";

export default { plugins: [[validateLinks, { repository: false }]] };
