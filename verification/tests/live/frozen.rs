//! Reference data made by a peer: is it still what the peer gives?

use ancf_check::Suite;
use ancf_verification::peers;

#[test]
fn frozen_tables_are_what_the_peers_give_today() {
    let suite = Suite::here();
    for name in suite.names().unwrap() {
        let case = suite.case(&name).unwrap();
        for (key, oracle) in &case.text.oracle {
            let Some(peer) = oracle.peer else { continue };
            let today = peers::table(&case, oracle, peer).unwrap_or_else(|e| panic!("{name}/{key}: {e}"));
            let frozen = std::fs::read_to_string(suite.table_path(&name, key))
                .unwrap_or_else(|e| panic!("{name}/{key}: {e}; `verify freeze {name}` makes it"));
            compare(&format!("{name}/{key}"), &today, &frozen);
        }
    }
}

/// Text is the same, numbers to 1e-9: another processor's round-off moves the last of the twelve decimals.
fn compare(name: &str, today: &str, frozen: &str) {
    assert_eq!(today.lines().count(), frozen.lines().count(), "{name}: number of rows");
    for (a, b) in today.lines().zip(frozen.lines()) {
        let same = a.split(',').count() == b.split(',').count()
            && a.split(',').zip(b.split(',')).all(|(a, b)| match (a.parse::<f64>(), b.parse::<f64>()) {
                (Ok(a), Ok(b)) => (a - b).abs() <= 1e-9 * a.abs().max(1.0),
                _ => a == b,
            });
        assert!(same, "{name}: today {a}, frozen {b}");
    }
}
