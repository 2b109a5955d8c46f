import "./strata-app";
