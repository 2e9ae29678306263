// main.ts — the live view: builds the page and connects it to the program that served it.
import "../styles/font.css";
import "../styles/tokens.css";
import "../styles/base.css";
import "../styles/mesh.css";
import "uplot/dist/uPlot.min.css";
import "./live.css";
import { startTheme } from "../page/theme.ts";
import { LivePage } from "./live_page.ts";

startTheme();
const page = new LivePage();
document.getElementById("live")?.replaceChildren(page.element);
page.connection.open();
