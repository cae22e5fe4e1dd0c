//! A person at the lab: opens pages, moves sliders, brings a log.

use super::rig::{Rig, minute_of_eighteen_joints};
use super::step::Step;
use handstand_browser::{Browser, LabServer};
use serde_json::json;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Longest cold start, and until a minute of 18 joints is drawn, ms.
const SECOND_MS: f64 = 1000.0;
/// Longest of any other step, ms.
const STEP_MS: f64 = 300.0;
/// Pages, and what shows that they are drawn; those without charts are drawn when loaded.
const PAGES: [(&str, &str); 7] = [
    ("data", "#raw[data-drawn]"),
    ("compare", "#curves[data-drawn]"),
    ("learn", ""),
    ("what-if", "#curves[data-answered]"),
    ("robot", ""),
    ("gains", ""),
    ("challenge", ""),
];

/// Moves a slider by a share of its length, and gives the time until the charts in `root` were
/// drawn from the answer, ms.
const SLIDE: &str = "\
new Promise((done) => {
  const slider = document.querySelector(SLIDER), root = document.querySelector(ROOT);
  let answered = false;
  const begun = performance.now();
  const seen = new MutationObserver((changes) => {
    for (const { attributeName } of changes) {
      if (attributeName === 'data-answered') answered = true;
      else if (attributeName === 'data-drawn' && answered) {
        seen.disconnect();
        done(performance.now() - begun);
        return;
      }
    }
  });
  seen.observe(root, { attributes: true });
  const step = (Number(slider.max) - Number(slider.min)) * SHARE;
  slider.value = Number(slider.value) + step;
  slider.dispatchEvent(new Event('input', { bubbles: true }));
})";

/// A browser, the program that it measures, and what was found.
pub struct Person {
    browser: Browser,
    program: PathBuf,
    rounds: usize,
}

impl Person {
    /// With a browser.
    pub fn new(mut browser: Browser, program: PathBuf, rounds: usize) -> Person {
        // A screen so tall that every chart is in sight: what is not is not drawn.
        let screen =
            json!({ "width": 1280, "height": 5000, "deviceScaleFactor": 1, "mobile": false });
        browser.call("Emulation.setDeviceMetricsOverride", screen);
        Person {
            browser,
            program,
            rounds,
        }
    }

    /// Opens every page of a rig, and moves every kind of slider.
    ///
    /// # Errors
    /// The system refuses.
    pub fn works_with(&mut self, rig: &Rig, steps: &mut Vec<Step>) -> Result<(), String> {
        let folder = tempfile::tempdir().map_err(|why| why.to_string())?;
        let files = rig.write(folder.path()).map_err(|why| why.to_string())?;
        let served = self.starts(rig.name, &files, folder.path(), steps)?;
        for (page, drawn) in PAGES {
            let times = (0..=self.rounds).map(|_| self.opens(&served.page(page), drawn));
            // What the first visit computes is kept.
            let times: Vec<f64> = times.collect();
            let what = format!("{}: page {page}", rig.name);
            // The first page that needs them fits start states, which is a fit.
            let (first, limit_ms) = match page {
                "compare" => ("first, fits start states", f64::INFINITY),
                _ => ("first", STEP_MS),
            };
            let first = format!("{what}, {first}");
            steps.push(Step::new(first, limit_ms, times[..1].to_vec()));
            steps.push(Step::new(what, STEP_MS, times[1..].to_vec()));
        }
        for (page, slider, root) in [
            ("what-if", "[data-path=\"link1.com_m\"]", "#curves"),
            ("compare", "#window", "#curves"),
            ("gains", "#states", "#response"),
        ] {
            let times = self.slides(&served.page(page), slider, root);
            let what = format!("{}: slider of {page}", rig.name);
            steps.push(Step::new(what, rig.slider_ms, times));
        }
        Ok(())
    }

    /// Brings a log of a minute of 18 joints.
    ///
    /// # Errors
    /// As [`Person::works_with`].
    pub fn brings_a_minute(&mut self, steps: &mut Vec<Step>) -> Result<(), String> {
        let folder = tempfile::tempdir().map_err(|why| why.to_string())?;
        let minute = folder.path().join("minute.csv");
        std::fs::write(&minute, minute_of_eighteen_joints()).map_err(|why| why.to_string())?;
        let served = LabServer::start_alone(&self.program, folder.path(), [""; 0]);
        self.browser.open(&served.address);
        self.browser.until("document.getElementById('drop')");
        let begun = Instant::now();
        self.browser.choose_files("#files", &[&minute]);
        self.browser
            .until("document.querySelector('#raw[data-drawn]')");
        let brought_ms = 1e3 * begun.elapsed().as_secs_f64();
        let what = "18 joints, 60 s, 100 Hz: brought and drawn";
        steps.push(Step::new(what, SECOND_MS, vec![brought_ms]));
        let page = served.page("data");
        let times = (0..self.rounds).map(|_| self.opens(&page, "#raw[data-drawn]"));
        let times = times.collect();
        let what = "18 joints, 60 s, 100 Hz: drawn";
        steps.push(Step::new(what, SECOND_MS, times));
        Ok(())
    }

    /// Starts the lab some times; the last one stays.
    fn starts(
        &mut self,
        name: &str,
        files: &[PathBuf],
        folder: &Path,
        steps: &mut Vec<Step>,
    ) -> Result<LabServer, String> {
        let start = |round: usize| {
            let folder = folder.join(round.to_string());
            std::fs::create_dir_all(&folder).map_err(|why| why.to_string())?;
            let begun = Instant::now();
            let served = LabServer::start_alone(&self.program, &folder, files);
            Ok::<_, String>((served, 1e3 * begun.elapsed().as_secs_f64()))
        };
        let mut times = Vec::new();
        for round in 1..self.rounds {
            times.push(start(round)?.1);
        }
        let begun = Instant::now();
        let (served, started_ms) = start(0)?;
        times.push(started_ms);
        self.browser.open(&served.address);
        self.browser.until("document.getElementById('drop')");
        let first_ms = 1e3 * begun.elapsed().as_secs_f64();
        steps.push(Step::new(format!("{name}: cold start"), SECOND_MS, times));
        let what = format!("{name}: cold start until the first page stands");
        steps.push(Step::new(what, SECOND_MS, vec![first_ms]));
        Ok(served)
    }

    /// Opens a page; time from the navigation until it is drawn, ms.
    fn opens(&mut self, address: &str, drawn: &str) -> f64 {
        self.browser.open(address);
        if drawn.is_empty() {
            let loaded = "performance.getEntriesByType('navigation')[0].loadEventEnd || null";
            return self.browser.number(loaded);
        }
        let selector = json!(drawn);
        self.browser.until(&format!(
            "document.querySelector({selector})?.dataset.drawn"
        ));
        self.browser.number(&format!(
            "Number(document.querySelector({selector}).dataset.drawn)"
        ))
    }

    /// Moves a slider to ever new places; times until the charts were drawn, ms.
    fn slides(&mut self, page: &str, slider: &str, root: &str) -> Vec<f64> {
        self.browser.open(page);
        self.browser.until(&format!(
            "document.querySelector({})?.dataset.drawn",
            json!(root)
        ));
        // What the page still asks for by itself is not the slider's.
        self.browser
            .value("new Promise((done) => setTimeout(done, 1000))");
        let slide = |share: f64| {
            let script = SLIDE.replace("SLIDER", &json!(slider).to_string());
            let script = script.replace("ROOT", &json!(root).to_string());
            script.replace("SHARE", &share.to_string())
        };
        (0..self.rounds)
            .map(|_| self.browser.number(&slide(-0.4 / self.rounds as f64)))
            .collect()
    }
}
