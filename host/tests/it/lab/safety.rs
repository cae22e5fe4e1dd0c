//! Who is let in, and what is refused.

use crate::common::Bench;
use serde_json::json;

#[test]
fn without_token_host_or_origin_nobody_is_let_in() {
    let bench = Bench::new();
    let server = bench.lab("model.toml a.csv b.csv");
    let cookie = ("Cookie", server.cookies.as_str());
    let ask =
        |method, headers: &[(&str, &str)]| server.ask(method, "/s/1/data", headers, b"").status;
    assert_eq!(ask("GET", &[cookie]), 200);
    assert_eq!(ask("GET", &[]), 401);
    let name = format!("handstand_lab_{}", server.port);
    assert_eq!(ask("GET", &[("Cookie", &format!("{name}=0123"))]), 401);
    assert_eq!(server.ask("GET", "/enter?token=0123", &[], b"").status, 401);
    assert_eq!(server.ask("GET", "/enter", &[], b"").status, 401);
    for host in [
        "evil.example",
        "127.0.0.1",
        "127.0.0.1:1",
        "localhost.evil.example",
    ] {
        assert_eq!(ask("GET", &[cookie, ("Host", host)]), 421, "{host}");
    }
    let local = format!("localhost:{}", server.port);
    assert_eq!(ask("GET", &[cookie, ("Host", &local)]), 200);
    let post = |origin: Option<&str>| {
        let json = ("Content-Type", "application/json");
        let mut headers = vec![cookie, json];
        headers.extend(origin.map(|origin| ("Origin", origin)));
        server
            .ask(
                "POST",
                "/s/1/horizon",
                &headers,
                br#"{"window":{"seconds":0.5}}"#,
            )
            .status
    };
    assert_eq!(post(None), 403);
    assert_eq!(post(Some("http://evil.example")), 403);
    assert_eq!(post(Some("null")), 403);
    assert_eq!(
        post(Some(&format!("https://127.0.0.1:{}", server.port))),
        403
    );
    assert_eq!(
        post(Some(&format!("http://127.0.0.1:{}", server.port))),
        200
    );
    assert_eq!(
        ask("GET", &[cookie, ("Origin", "http://evil.example")]),
        403
    );
}

#[test]
fn a_page_may_run_nothing_but_the_lab_s_own_scripts() {
    let bench = Bench::new();
    let server = bench.lab("model.toml a.csv b.csv");
    let pages = [
        "data",
        "compare",
        "learn",
        "what-if",
        "robot",
        "stage",
        "gains",
        "challenge",
    ];
    for name in pages {
        let page = server.get(&format!("/s/1/{name}"));
        assert_eq!(page.status, 200, "{name}");
        assert!(
            page.head
                .contains("content-security-policy: default-src 'self';"),
            "{name}"
        );
        assert!(!page.head.contains("unsafe"), "{name}");
        let text = page.text();
        assert!(
            !text.contains(" style=") && !text.contains("<style"),
            "{name}"
        );
        for part in text.split("<script").skip(1) {
            let tag = part.split('>').next().unwrap();
            let data = tag.contains("type=\"application/json\"");
            assert!(data || tag.contains("src=\"/assets/"), "{name}: {tag}");
        }
        for event in [
            " onclick",
            " onload",
            " onerror",
            "javascript:",
            "//cdn",
            "https://",
        ] {
            assert!(!text.contains(event), "{name} holds {event}");
        }
    }
    for (path, status) in [
        ("/assets/lab.js", 200),
        ("/assets/../Cargo.toml", 404),
        ("/assets/..%2f..%2fCargo.toml", 404),
        ("/s/1/raw?file=../session.json", 404),
        ("/s/1/raw?file=%2e%2e%2f..%2f..%2fmodel.toml", 404),
        ("/s/1/raw?file=/etc/passwd", 404),
        ("/s/1/download/..%2f..%2fmodel.toml", 404),
        ("/s/9/data", 404),
        ("/s/1/curves?motion=99", 404),
        ("/s/1/scatter?joint=7", 404),
        ("/s/-1/data", 400),
    ] {
        assert_eq!(server.get(path).status, status, "{path}");
    }
    let folder = bench.path("sessions/1/logs");
    let names = || std::fs::read_dir(&folder).unwrap().count();
    let before = names();
    for name in [
        "..%2f..%2fx.csv",
        "%2fetc%2fcron.csv",
        "a%00b.csv",
        "..%5cy.csv",
    ] {
        let path = format!("/s/1/upload?name={name}");
        assert_eq!(
            server.post_bytes(&path, "text/csv", b"t,q\n0,1\n").status,
            200,
            "{name}"
        );
    }
    assert_eq!(
        names(),
        before + 4,
        "all of them are in the session's folder"
    );
    assert!(!bench.path("sessions/x.csv").exists() && !bench.path("x.csv").exists());
    let program = server.post_bytes("/s/1/upload?name=x.exe", "text/csv", b"MZ");
    assert_eq!(program.status, 422);
}

#[test]
fn too_large_a_log_is_refused_with_the_reason() {
    let bench = Bench::new();
    let server = bench.lab("model.toml a.csv");
    let origin = format!("http://127.0.0.1:{}", server.port);
    let common = [
        ("Cookie", server.cookies.as_str()),
        ("Origin", origin.as_str()),
    ];
    // Announced: refused before a byte of it is taken.
    let announced = [common.as_slice(), &[("Content-Length", "1073741824")]].concat();
    let refused = server.ask("POST", "/s/1/upload?name=huge.csv", &announced, b"t,q\n");
    assert_eq!(refused.status, 413);
    assert!(
        refused.json()["error"]
            .as_str()
            .unwrap()
            .contains("256 MiB")
    );
    // Not announced: refused when it grows too long.
    let streamed = [common.as_slice(), &[("Transfer-Encoding", "chunked")]].concat();
    let chunk = [b"1000000\r\n".as_slice(), &vec![b'1'; 1 << 24], b"\r\n"].concat();
    let refused = server.ask(
        "POST",
        "/s/1/upload?name=huge.csv",
        &streamed,
        &chunk.repeat(18),
    );
    assert_eq!(refused.status, 413);
    assert!(
        refused.json()["error"]
            .as_str()
            .unwrap()
            .contains("256 MiB")
    );
    let form = json!({ "toml": "x".repeat(2 << 20) });
    assert_eq!(server.post("/s/1/model", &form).status, 413);
    assert_eq!(server.get("/s/1/data").status, 200, "it serves on");
    assert!(!bench.path("sessions/1/logs/huge.csv").exists());
}

#[test]
fn markup_and_what_is_no_number_do_no_harm() {
    let bench = Bench::new();
    let server = bench.lab("");
    let name = "<img src=x onerror=alert(1)>";
    let log = format!("time_s,\"{name}\"\n0,NaN\n0.1,inf\n0.2,<script>\n0.3\n");
    let path = "/s/1/upload?name=%3Cb%3E.csv";
    assert_eq!(
        server.post_bytes(path, "text/csv", log.as_bytes()).status,
        200
    );
    let (meta, arrays) = server.get("/s/1/raw?file=_b_.csv").curves();
    assert_eq!(meta["names"][1], name);
    assert!(arrays[2].1[0].is_nan() && arrays[2].1[3].is_nan());
    let model = bench
        .get("model.toml")
        .replace("pendulum\"", "<script>alert(1)</script>\"");
    assert_eq!(
        server.post("/s/1/model", &json!({ "toml": model })).status,
        200
    );
    for page in ["/s/1/data", "/s/1/compare", "/s/1/learn", "/sessions"] {
        let text = server.get(page).text();
        assert!(
            !text.contains("<img") && !text.contains("<script>alert"),
            "{page}"
        );
    }
    let text = server.get("/s/1/data").text();
    assert!(text.contains("&lt;img"), "the name is there, as text");
    for broken in ["\u{0}\u{1}", "", "a,b", "\"", "time_s,angle_rad\n0,0\n"] {
        let path = "/s/1/upload?name=broken.csv";
        assert_eq!(
            server
                .post_bytes(path, "text/csv", broken.as_bytes())
                .status,
            200
        );
    }
    assert_eq!(
        server
            .post_bytes("/s/1/upload?name=b.json", "", b"{\"entries\":[}")
            .status,
        200
    );
    assert_eq!(server.get("/s/1/data").status, 200);
    assert_eq!(
        server
            .post("/s/1/horizon", &json!({ "window": { "seconds": 1e-9 } }))
            .status,
        409
    );
    assert_eq!(
        server
            .post("/s/1/horizon", &json!({ "window": "x" }))
            .status,
        422
    );
    assert_eq!(
        server.post("/s/1/model", &json!({ "toml": "[rig" })).status,
        422
    );
}

#[test]
fn a_browser_that_goes_astray_gets_a_page_with_style() {
    let bench = Bench::new();
    let server = bench.lab("model.toml a.csv");
    let html = ("Accept", "text/html,application/xhtml+xml");
    let cookie = ("Cookie", server.cookies.as_str());
    for (path, status, word) in [
        ("/s/99/data", 404, "There is no such session"),
        ("/s/1/nopage", 404, "There is no such page"),
        ("/s/one/data", 400, "no address of the lab"),
        ("/s/1/download/next.csv", 404, "There is no such motion"),
    ] {
        let page = server.ask("GET", path, &[cookie, html], b"");
        assert_eq!(page.status, status, "{path}");
        let text = page.text();
        assert!(
            text.contains(word) && text.contains("/assets/lab.css"),
            "{path}: {text}"
        );
        let data = server.ask("GET", path, &[cookie], b"");
        assert!(!data.text().contains("<html"), "{path}: a script gets data");
    }
    // Who is refused gets the style, too; nothing else.
    let refused = server.ask("GET", "/s/1/data", &[html], b"");
    assert_eq!(refused.status, 401);
    assert!(refused.text().contains("/assets/lab.css"));
    assert_eq!(server.ask("GET", "/assets/lab.css", &[], b"").status, 200);
    let evil = [("Host", "evil.example")];
    assert_eq!(server.ask("GET", "/assets/lab.css", &evil, b"").status, 421);
}
