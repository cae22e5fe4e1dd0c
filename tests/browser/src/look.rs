//! How a page looks: pictures of it, and what is wrong with labels, contrast and width.

use super::Browser;
use base64::Engine as _;
use serde_json::json;
use std::path::Path;

impl Browser {
    /// What axe-core finds wrong with the page as it is: labels, contrast, roles. Nothing where
    /// it is not installed, and a line that says so.
    fn judged(&mut self) -> Vec<String> {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let folders = [root.join("target"), self.pictures.join("../..")];
        let place = "npm/node_modules/axe-core/axe.min.js";
        let found = folders
            .iter()
            .find_map(|folder| std::fs::read_to_string(folder.join(place)).ok());
        let Some(axe) = found else {
            println!("left out: axe-core is not here, `cargo xtask install` brings it");
            return Vec::new();
        };
        // In one question: between two, the page may load again without it.
        let found = self.value(&format!(
            "{axe};\naxe.run(document, {{ iframes: false }}).then((found) => \
             found.violations.flatMap((v) => v.nodes.map((node) => \
             `${{v.id}}: ${{node.html.slice(0, 160)}} ${{node.failureSummary}}`)))"
        ));
        let found = found.as_array().expect("axe ran").iter();
        found
            .map(|each| each.as_str().unwrap().to_string())
            .collect()
    }

    /// The page at 1280 and 800 pixels, light and dark, as pictures in its folder.
    /// What axe-core finds wrong with it, and what sticks out, are complaints.
    pub fn pictures(&mut self, name: &str) {
        let folder = self.pictures.clone();
        std::fs::create_dir_all(&folder).unwrap();
        for width in [1280, 800] {
            for scheme in ["light", "dark"] {
                self.look(width, scheme);
                let shot = json!({ "format": "png", "captureBeyondViewport": true });
                let picture = self.call("Page.captureScreenshot", shot);
                let png = base64::engine::general_purpose::STANDARD
                    .decode(picture["data"].as_str().unwrap())
                    .unwrap();
                assert!(png.len() > 5000, "{name} is not blank");
                std::fs::write(folder.join(format!("{name}-{width}-{scheme}.png")), png).unwrap();
                let wrong = self.judged();
                let place = |wrong| format!("{name} at {width} px, {scheme}: {wrong}");
                self.complaints.extend(wrong.into_iter().map(place));
                let wide = self.number("document.documentElement.scrollWidth - innerWidth");
                if wide > 0.0 {
                    let wide = format!("{name} at {width} px is too wide by {wide} px");
                    self.complaints.push(wide);
                }
            }
        }
        self.look(1280, "light");
    }

    fn look(&mut self, width: u32, scheme: &str) {
        let features = json!([{ "name": "prefers-color-scheme", "value": scheme }]);
        self.call(
            "Emulation.setEmulatedMedia",
            json!({ "features": features }),
        );
        self.until("document.readyState === 'complete'");
        let height = self.number("Math.max(600, Math.min(4000, document.body.scrollHeight + 40))");
        let size = json!({
            "width": width, "height": height as u32, "deviceScaleFactor": 1, "mobile": false,
        });
        self.call("Emulation.setDeviceMetricsOverride", size);
        // Charts are drawn again with the next frame.
        self.value(
            "new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => \
             setTimeout(done, 60))))",
        );
    }
}
