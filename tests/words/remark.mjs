// Links of the documents to each other, to their headings and to files of the source.
import validateLinks from "remark-validate-links";

export default { plugins: [[validateLinks, { repository: false }]] };
