//! Laws of time.

use toml::{Table, Value};

use super::super::formula::number;
use super::Draw;

impl Draw<'_> {
    /// A law that changes within the motion; `smooth` if the driven quantity must not jump and must
    /// start at rest.
    pub(super) fn law(&mut self, smooth: bool) -> Table {
        let duration = self.duration;
        let mut law = Table::new();
        if self.chance(0.12) {
            let laws = vec![Value::from(self.law(smooth)), Value::from(self.law(smooth))];
            law.insert(self.pick(&["sum", "product"]).into(), Value::Array(laws));
            return law;
        }
        let mut inner = Table::new();
        let kind = match self.rng.u8(0..15) {
            12.. => "expression",
            0..2 => "ramp",
            2..4 => "smooth_ramp",
            4 => "step",
            5..8 => "harmonic",
            8..10 => "polynomial",
            _ => "table",
        };
        let kind = match kind {
            "step" if smooth => "smooth_ramp",
            kind => kind,
        };
        match kind {
            "expression" => {
                let expression = self.expression(smooth);
                law.insert(kind.into(), expression);
                return law;
            }
            "ramp" | "smooth_ramp" => {
                if self.chance(0.5) {
                    inner.insert("start".into(), (duration * self.even(0.0, 0.5)).into());
                }
                inner.insert("duration".into(), (duration * self.even(0.1, 0.8)).into());
            }
            "step" => {
                inner.insert("start".into(), (duration * self.even(0.0, 0.8)).into());
            }
            "harmonic" => {
                let cycles = self.log(0.1, 10.0);
                inner.insert("frequency".into(), (cycles / duration).into());
                if !smooth && self.chance(0.5) {
                    inner.insert("phase".into(), self.even(-3.0, 3.0).into());
                }
            }
            "polynomial" => {
                let n = self.rng.usize(1..4);
                let mut coefficients: Vec<f64> =
                    (0..=n).map(|power| self.even(-1.0, 1.0) / duration.powi(power as i32)).collect();
                if smooth {
                    coefficients[0] = 0.0;
                }
                law.insert(kind.into(), Value::Array(coefficients.into_iter().map(Value::Float).collect()));
                return law;
            }
            _ => {
                let n = self.rng.usize(2..5);
                let times = (0..n).map(|i| Value::Float(duration * i as f64 / (n - 1) as f64));
                let times: Vec<Value> = times.collect();
                let first = if smooth { 0.0 } else { self.even(-1.0, 1.0) };
                let mut values = vec![Value::Float(first)];
                values.extend((1..n).map(|_| Value::Float(self.even(-1.0, 1.0))));
                inner.insert("times".into(), times.into());
                inner.insert("values".into(), values.into());
                if self.chance(0.5) {
                    inner.insert("smooth".into(), true.into());
                }
            }
        }
        law.insert(kind.into(), inner.into());
        law
    }

    /// An expression in t; zero at the start if `smooth`.
    fn expression(&mut self, smooth: bool) -> Value {
        let duration = self.duration;
        let mut rate = |low: f64, high: f64| number(self.log(low, high) / duration);
        let (slow, fast, turn) = (rate(0.5, 5.0), rate(1.0, 30.0), self.even(0.1, 0.9) * duration);
        let at = number(turn);
        let kinked = if smooth { 2 } else { 5 };
        match self.rng.u8(0..kinked) {
            0 => format!("sin({fast}*t)*exp(-{slow}*t)").into(),
            1 => format!("1-cos({fast}*t)/(1+({slow}*t)^2)").into(),
            2 => format!("exp(-({fast}*(t-{at}))^2)").into(),
            3 => format!("tanh({slow}*(t-{at}))+0.3*cos(2*pi*{slow}*t)").into(),
            _ => {
                let mut table = Table::new();
                table.insert("of".into(), format!("sqrt(({slow}*(t-{at}))^2)").into());
                table.insert("kinks".into(), Value::Array(vec![turn.into()]));
                table.into()
            }
        }
    }

    /// In a motion, adds a law with the probability `share`.
    pub(super) fn perhaps_in_time(&mut self, table: &mut Table, share: f64) {
        if self.is_motion() && self.chance(share) {
            let law = self.law(false);
            table.insert("in_time".into(), law.into());
        }
    }
}
