//! Reference data made by a peer: is it still what the peer gives? `verify freeze --check` asks the same of what takes
//! longer.

use ancf_check::Suite;
use ancf_check::reference::difference;
use ancf_verification::peers;

#[test]
fn frozen_tables_are_what_the_peers_give_today() {
    let suite = Suite::here();
    let mut compared = 0;
    for name in suite.names().unwrap() {
        let case = suite.case(&name).unwrap();
        for (key, oracle) in &case.text.oracle {
            let Some(peer) = oracle.peer.filter(|_| !case.text.nightly && !oracle.nightly) else { continue };
            let today = peers::table(&case, oracle, peer).unwrap_or_else(|e| panic!("{name}/{key}: {e}"));
            let frozen = std::fs::read_to_string(suite.table_path(&name, key))
                .unwrap_or_else(|e| panic!("{name}/{key}: {e}; `verify freeze {name}` makes it"));
            // Catches a version of a peer, or a change of its script, that gives other numbers.
            assert_eq!(difference(&today, &frozen), None, "{name}/{key}");
            compared += 1;
        }
    }
    assert!(compared > 0, "no table of a peer");
}
