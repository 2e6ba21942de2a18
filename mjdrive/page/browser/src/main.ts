// A page with a drive inside plays that; any other one shows what its server drives.
import "./style.css";

await (document.getElementById("drive") ? import("./alone") : import("./serving"));
