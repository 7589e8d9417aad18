//! Keys of stages, and when the tables of a scene take part.

use schemars::JsonSchema;
use serde::Deserialize;

use super::*;
use crate::scene::value::Located;

/// An analysis that starts where the stage before it ended.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StageTable {
    /// Its name, by which effects, supports and joints refer to it; also that of its folder.
    pub name: Located<String>,
    /// What to compute: exactly one kind.
    pub analysis: Located<AnalysisTable>,
}

/// The stages at whose start something comes and goes.
#[derive(Clone, Copy)]
pub struct During<'f> {
    /// The first when left out.
    pub stage: Option<&'f Located<String>>,
    /// It stays to the end when left out.
    pub until: Option<&'f Located<String>>,
}

/// A table of something that may come and go.
pub trait Staged {
    /// When it takes part.
    fn during(&self) -> During<'_>;
}

impl<T: Staged> Staged for Located<T> {
    fn during(&self) -> During<'_> {
        self.get().during()
    }
}

macro_rules! staged {
    ($($table:ty),* $(,)?) => {$(
        impl Staged for $table {
            fn during(&self) -> During<'_> {
                During { stage: self.stage.as_ref(), until: self.until.as_ref() }
            }
        }
    )*};
}

staged!(
    SupportTable,
    JointTable,
    ForceTable,
    MomentTable,
    DistributedForceTable,
    GravityTable,
    DampingTable,
    SpringTable,
    TorsionSpringTable,
    PointMassTable,
    SectionInertiaTable,
    FoundationTable,
    ActuationTable,
    TendonTable,
    DragTable,
    BuoyancyTable,
    ElectrostaticTable,
    ForceFieldTable,
    MovingForceTable,
    ContactTable,
);

/// Does something with the list of every kind of table that may come and go, in order.
macro_rules! for_each_list {
    ($scene:expr, $list:ident => $action:expr) => {{
        let SceneTable { support, joint, effect, .. } = $scene;
        let EffectTable {
            force,
            moment,
            distributed_force,
            gravity,
            damping,
            spring,
            torsion_spring,
            point_mass,
            rotary_inertia,
            foundation,
            actuation,
            tendon,
            drag,
            buoyancy,
            electrostatic,
            force_field,
            moving_force,
            contact,
        } = effect;
        for_each_list!(
            @each $list => $action,
            support, joint, force, moment, distributed_force, gravity, damping, spring, torsion_spring,
            point_mass, rotary_inertia, foundation, actuation, tendon, drag, buoyancy, electrostatic,
            force_field, moving_force, contact
        );
    }};
    (@each $list:ident => $action:expr, $($field:ident),*) => {
        $({
            let $list = $field;
            $action
        })*
    };
}

impl SceneTable {
    /// When the supports, joints and effects take part, in order.
    pub fn durings(&self) -> Vec<During<'_>> {
        let mut all = Vec::new();
        for_each_list!(self, list => all.extend(list.iter().map(Staged::during)));
        all
    }

    /// Keeps those supports, joints and effects for which `keep` holds.
    pub fn retain(&mut self, keep: &dyn Fn(During<'_>) -> bool) {
        for_each_list!(self, list => list.retain_tables(keep));
    }
}

/// A list of tables, or a table that may be left out.
trait Tables {
    fn retain_tables(&mut self, keep: &dyn Fn(During<'_>) -> bool);
}

impl<T: Staged> Tables for Vec<T> {
    fn retain_tables(&mut self, keep: &dyn Fn(During<'_>) -> bool) {
        self.retain(|table| keep(table.during()));
    }
}

impl<T: Staged> Tables for Option<T> {
    fn retain_tables(&mut self, keep: &dyn Fn(During<'_>) -> bool) {
        self.take_if(|table| !keep(table.during()));
    }
}
