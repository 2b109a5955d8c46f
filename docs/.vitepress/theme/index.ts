import theme from "vitepress/theme-without-fonts";
import "./strata.css";

export default theme;
