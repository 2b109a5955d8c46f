// The elements of the history, which the page loads after its first picture.

import "./past-bar";
import "./past-overlay";
import "./past-since";
