//! `diagnose --each`: every log of a folder by itself, in shards, with a table and a page.

use crate::common::Bench;

/// A folder of two good logs and one that cannot be read.
fn bench() -> Bench {
    let bench = Bench::new();
    std::fs::create_dir(bench.path("logs")).unwrap();
    for name in ["a.csv", "b.csv"] {
        bench.put(&format!("logs/{name}"), bench.get(name));
    }
    let torn = bench.get("a.csv").replacen("0.03,", "0.03,?", 1);
    bench.put("logs/c.csv", torn);
    bench
}

#[test]
fn shards_and_a_torn_line_end_in_the_table_of_one_run() {
    let bench = bench();
    let whole = bench.run("diagnose model.toml --each logs -o whole --json");
    assert_eq!(whole.code, Some(0), "{whole:?}");
    let outcomes = whole.json()["outcomes"].as_array().unwrap().clone();
    assert_eq!(outcomes.len(), 3);
    for outcome in &outcomes[..2] {
        assert!(
            outcome["after_rad"].as_f64() < outcome["before_rad"].as_f64(),
            "{outcome}"
        );
        assert!(outcome["values"][0]["low"].as_f64() < outcome["values"][0]["value"].as_f64());
    }
    assert_ne!(outcomes[2]["verdict"], outcomes[0]["verdict"]);
    assert!(
        outcomes[2]["said"].to_string().contains("c.csv:"),
        "{outcomes:?}"
    );
    assert!(bench.get("whole/logs.html").contains("viscous@1"));

    for shard in ["1/2", "2/2"] {
        let ran = bench.run(&format!(
            "diagnose model.toml --each logs -o parts --shard {shard}"
        ));
        assert_eq!(ran.code, Some(0), "{ran:?}");
    }
    // A crash tears the last line: it alone is done again.
    let lines = bench.get("parts/shard-1-of-2.jsonl");
    assert_eq!(lines.lines().count(), 2);
    bench.put("parts/shard-1-of-2.jsonl", &lines[..lines.len() - 9]);
    let again = bench.run("diagnose model.toml --each logs -o parts --shard 1/2");
    assert!(
        again.stderr.contains("1 of 2 logs are done already"),
        "{again:?}"
    );
    assert_eq!(bench.get("parts/shard-1-of-2.jsonl"), lines);
    let merged = bench.run("diagnose model.toml --each logs -o parts");
    assert!(
        merged.stderr.contains("3 of 3 logs are done already"),
        "{merged:?}"
    );
    for file in ["logs.csv", "logs.html"] {
        assert_eq!(
            bench.get(&format!("parts/{file}")),
            bench.get(&format!("whole/{file}"))
        );
    }
}

#[test]
fn another_model_is_diagnosed_again_and_nothing_is_overwritten_unasked() {
    let bench = bench();
    std::fs::remove_file(bench.path("logs/b.csv")).unwrap();
    let first = bench.run("diagnose model.toml --each logs -o out");
    assert_eq!(first.code, Some(0), "{first:?}");
    assert!(first.stdout.contains("2 logs: 1 "), "{first:?}");
    bench.put(
        "model.toml",
        bench.get("model.toml") + "\n# weighed again\n",
    );
    let second = bench.run("diagnose model.toml --each logs -o out");
    assert!(!second.stderr.contains("done already"), "{second:?}");
    // Only the fingerprint differs, so that table and page are the same.
    assert_eq!(second.code, Some(0), "{second:?}");
    bench.put("out/logs.csv", "mine\n");
    let third = bench.run("diagnose model.toml --each logs -o out");
    assert_eq!(third.code, Some(2), "{third:?}");
    assert_eq!(bench.get("out/logs.csv"), "mine\n");
    let alone = bench.run("diagnose model.toml --each logs");
    assert_eq!(alone.code, Some(2), "{alone:?}");
    let both = bench.run("diagnose model.toml a.csv --each logs -o out");
    assert_eq!(both.code, Some(2), "{both:?}");
    std::fs::remove_file(bench.path("logs/a.csv")).unwrap();
    let none = bench.run("diagnose model.toml --each logs -o none --json");
    assert_eq!(none.code, Some(1), "{none:?}");
}
