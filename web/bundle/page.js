var Lt=class extends Error{constructor(e){super(e.detail??e.title??""),this.body=e,this.code=e.code??"other"}},pr=i=>!["queued","running"].includes(i.state),mr=class{constructor(){this.key=jd()}useKey(e){this.key=e;try{sessionStorage.setItem("key",e)}catch{}}async call(e,t={}){let n={...t.headers,...this.key?{Authorization:`Bearer ${this.key}`}:{}},s=await fetch(e,{...t,headers:n}).catch(r=>{throw r.name==="AbortError"?r:new Lt({code:"unreachable"})});if(!s.ok)throw new Lt(await s.json().catch(()=>({code:"other",detail:`HTTP ${s.status}`})));return s}async json(e,t){return(await this.call(e,t)).json()}create(e,t=null){if(!t)return this.json("/v1/jobs",{method:"POST",headers:{"Content-Type":"application/json"},body:JSON.stringify(e)});let n=new FormData;n.append("job",new Blob([JSON.stringify(e)],{type:"application/json"}));for(let s of[t].flat())n.append("mesh",s,s.name);return this.json("/v1/jobs",{method:"POST",body:n})}job=e=>this.json(`/v1/jobs/${e}`);report=e=>this.json(e.links.report);cancel=e=>this.json(`${e.links.self}/cancel`,{method:"POST"});async file(e,t="*/*"){let n=await this.call(e,{headers:{Accept:t}});return{name:Zd(n.headers.get("Content-Disposition")??""),blob:await n.blob()}}async follow(e,t){if(pr(e))return e;try{let s=await this.call(`${e.links.self}/events`,{headers:{Accept:"text/event-stream"}});for await(let r of Jd(s.body))t(r)}catch(s){if(s instanceof Lt&&s.code!=="unreachable")throw s}let n=await this.job(e.id);for(;!pr(n);)t({name:"progress",data:n}),n=await this.json(`${e.links.self}?wait=20`);return n}};function Zd(i){let e=/filename\*=UTF-8''([^;\s]+)/i.exec(i)?.[1];return e?decodeURIComponent(e):/filename="([^"]*)"/.exec(i)?.[1]??"mesh"}function jd(){try{return sessionStorage.getItem("key")??""}catch{return""}}async function*Jd(i){let e=i.pipeThrough(new TextDecoderStream).getReader(),t="";for(;;){let{value:n,done:s}=await e.read();if(s)return;t+=n;let r=t.split(`

`);t=r.pop();for(let o of r){let a=Object.fromEntries(o.split(`
`).map(l=>[l.slice(0,l.indexOf(":")),l.slice(l.indexOf(":")+1).trim()]));a.data&&(yield{name:a.event,data:JSON.parse(a.data)})}}}var wi=class i{constructor(){this.remedies=new Map,this.elements=new Map,this.takesBest=!1,this.share=1,this.levels=1}static of({plan:e,require:t,ratio:n,targets:s}){let r=new i;r.takesBest=t==="best_effort",r.share=s?.[0]?.ratio??n??1,r.levels=s?.length??1;for(let{code:o,remedy:a,elements:l}of e?.findings??[]){a&&r.setRemedy(o,a);for(let{number:c,...h}of l)r.setElement(o,c,h)}return r}setRemedy(e,t){this.remedies.set(e,t)}setElement(e,t,n){let s=this.elements.get(e)??new Map;s.set(t,{...s.get(t),...n}),this.elements.set(e,s)}element(e,t){return this.elements.get(e)?.get(t)??{}}plan(e){let t=e.findings.flatMap(n=>{let{code:s}=n,r=this.remedies.get(s)??n.remedy,o=[...this.elements.get(s)??[]].filter(([,{remedy:l,method:c}])=>l||c);if(r===n.remedy&&o.length===0)return[];let a=o.map(([l,{remedy:c,method:h}])=>({number:l,remedy:c||Kd(n,l,r),...h?{method:h}:{}}));return[{code:s,...r===n.remedy?{}:{remedy:r},elements:a}]});return t.length?{input_sha256:e.input_sha256,findings:t}:null}options(e){let t=e&&this.plan(e);return{...t?{plan:t}:{},...this.takesBest?{require:"best_effort"}:{},...this.simplification()}}simplification(){return this.levels>1?{targets:Array.from({length:this.levels},(e,t)=>({ratio:this.share/2**t}))}:this.share<1?{ratio:this.share}:{}}},Kd=(i,e,t)=>(t===i.remedy?i.elements.find(n=>n.number===e)?.remedy:null)??t;var Fc={lead:["See what is wrong with a mesh, repair it, and get proof.","Sehen, was an einem Netz nicht stimmt, es reparieren, und den Beweis dazu.","Voir ce qui ne va pas dans un maillage, le r\xE9parer, et en avoir la preuve."],drop:["Drop a mesh here","Netz hier ablegen","D\xE9posez un maillage ici"],"drop.formats":["STL, OBJ, PLY, OFF, 3MF, GLB or glTF. It goes to this service only.","STL, OBJ, PLY, OFF, 3MF, GLB oder glTF. Die Datei geht nur an diesen Dienst.","STL, OBJ, PLY, OFF, 3MF, GLB ou glTF. Il ne va qu\u2019\xE0 ce service."],choose:["Choose a file","Datei w\xE4hlen","Choisir un fichier"],"open.other":["Another file","Andere Datei","Autre fichier"],samples:["or try one of these","oder eines hiervon ausprobieren","ou essayez l\u2019un de ceux-ci"],"sample.scan":["Broken scan","L\xF6chriger Scan","Scan ab\xEEm\xE9"],"sample.bodies":["Several bodies","Mehrere K\xF6rper","Plusieurs corps"],"sample.project":["3MF project","3MF-Projekt","Projet 3MF"],"sample.sound":["Sound part","Fehlerfreies Teil","Pi\xE8ce correcte"],file:["File","Datei","Fichier"],size:["Size","Gr\xF6\xDFe","Taille"],triangles:["Triangles","Dreiecke","Triangles"],unit:["Unit","Einheit","Unit\xE9"],"unit.assumed":["{u}, assumed","{u}, angenommen","{u}, suppos\xE9"],"unit.as":["{a} if {u}","{a} falls {u}","{a} si {u}"],"unit.question":["The file states no unit. Longest side: {a}.","Die Datei nennt keine Einheit. L\xE4ngste Seite: {a}.","Le fichier n\u2019indique pas d\u2019unit\xE9. Plus long c\xF4t\xE9 : {a}."],process:["Print process","Druckverfahren","Proc\xE9d\xE9 d\u2019impression"],"process.none":["none","keines","aucun"],findings:["Findings","Befunde","Constats"],"findings.none":["Nothing is wrong.","Alles in Ordnung.","Rien \xE0 signaler."],"findings.first":["The first {n} of {m} can be shown one by one.","Die ersten {n} von {m} sind einzeln zu sehen.","Les {n} premiers sur {m} peuvent \xEAtre montr\xE9s."],"show.in.view":["Show in the picture: {x}","Im Bild zeigen: {x}","Montrer dans l\u2019image : {x}"],places:["Places","Stellen","Endroits"],place:["Place {n}","Stelle {n}","Endroit {n}"],hole:["Hole {n}: {x}","Loch {n}: {x}","Trou {n} : {x}"],next:["Next","Weiter","Suivant"],previous:["Previous","Zur\xFCck","Pr\xE9c\xE9dent"],"what.to.do":["What to do","Was geschieht damit","Que faire"],how:["How","Wie","Comment"],"as.all":["as all: {x}","wie alle: {x}","comme tous : {x}"],sure:["how sure: {p}","wie sicher: {p}","certitude : {p}"],fixed:["mended","behoben","r\xE9par\xE9"],left:["{n} left","{n} \xFCbrig","{n} restants"],"left.one":["1 left","1 \xFCbrig","1 restant"],"or.more":["{n} or more","{n} oder mehr","{n} ou plus"],"place.told":["{x}, {n} of {m}","{x}, {n} von {m}","{x}, {n} sur {m}"],parts:["Parts","Teile","Pi\xE8ces"],"part.object":["Object {n}","Objekt {n}","Objet {n}"],"part.volume":["Object {n}, volume {m}","Objekt {n}, Volumen {m}","Objet {n}, volume {m}"],"part.times":["{n} times.","{n}-mal.","{n} fois."],"part.unused":["Not in the build.","Nicht im Druck.","Hors fabrication."],"part.sound":["sound","in Ordnung","correct"],"part.broken":["defects","Fehler","d\xE9fauts"],"part.attributes":["Colours and paint stay on {p} of its area.","Farben und Bemalung bleiben auf {p} der Fl\xE4che.","Couleurs et peinture gard\xE9es sur {p} de la surface."],solid:["What the parts become","Was aus den Teilen wird","Ce que deviennent les pi\xE8ces"],"solid.separate":["each its own solid, in the same project","jedes ein eigener K\xF6rper, im selben Projekt","chacune son solide, dans le m\xEAme projet"],"solid.union":["mended one by one, then united","einzeln repariert, dann vereinigt","r\xE9par\xE9es une \xE0 une, puis unies"],"solid.together":["one solid of all, as they stand","ein K\xF6rper aus allen, wie sie stehen","un seul solide de toutes, telles quelles"],remarks:["Remarks on the file: {n}","Anmerkungen zur Datei: {n}","Remarques sur le fichier : {n}"],several:["{n} files","{n} Dateien","{n} fichiers"],"several.how":["Make one solid of them","Einen K\xF6rper daraus machen","En faire un seul solide"],"several.union":["union","Vereinigung","union"],"several.intersection":["intersection","Schnittmenge","intersection"],"several.difference":["difference: the first without the others","Differenz: die erste ohne die anderen","diff\xE9rence : le premier sans les autres"],"several.combine":["Combine","Verbinden","Combiner"],"several.first":["Open the first only","Nur die erste \xF6ffnen","N\u2019ouvrir que le premier"],"verdict.bad":["Not printable as it is","So nicht druckbar","Pas imprimable en l\u2019\xE9tat"],"verdict.good":["A valid solid","Ein g\xFCltiger K\xF6rper","Un solide valide"],"verdict.good.more":["Proved on every byte of the file.","Bewiesen an jedem Byte der Datei.","Prouv\xE9 sur chaque octet du fichier."],"verdict.bad.more":["{n} kinds of defects must be mended.","{n} Arten von Fehlern m\xFCssen behoben werden.","{n} types de d\xE9fauts \xE0 r\xE9parer."],"verdict.bad.more.one":["One kind of defect must be mended.","Eine Art von Fehlern muss behoben werden.","Un type de d\xE9fauts \xE0 r\xE9parer."],"verdict.repaired":["Certified","Zertifiziert","Certifi\xE9"],"verdict.partial":["Not certified","Nicht zertifiziert","Non certifi\xE9"],"verdict.refused":["No result","Kein Ergebnis","Pas de r\xE9sultat"],"policy.holds":["Fit for {p}","Geeignet f\xFCr {p}","Convient pour {p}"],"policy.breaks":["Not fit for {p}","Nicht geeignet f\xFCr {p}","Ne convient pas pour {p}"],"policy.unknown":["Fit for {p}? Not known before it is repaired.","Geeignet f\xFCr {p}? Erst nach der Reparatur zu sagen.","Convient pour {p} ? \xC0 savoir apr\xE8s r\xE9paration."],repair:["Repair","Reparieren","R\xE9parer"],certify:["Certify","Zertifizieren","Certifier"],"repair.again":["Repair again","Noch einmal reparieren","R\xE9parer \xE0 nouveau"],earlier:["The result was made with another choice. Repair again to take this one.","Das Ergebnis wurde mit einer anderen Wahl gemacht. Reparieren Sie noch einmal, damit diese gilt.","Le r\xE9sultat a \xE9t\xE9 fait avec un autre choix. R\xE9parez \xE0 nouveau pour appliquer celui-ci."],"look.again":["Look again","Noch einmal ansehen","Examiner \xE0 nouveau"],cancel:["Cancel","Abbrechen","Annuler"],"best.effort":["Take the best there is, also unproved","Das Beste nehmen, auch ohne Beweis","Prendre le meilleur, m\xEAme sans preuve"],levels:["Levels of detail","Detailstufen","Niveaux de d\xE9tail"],"levels.half":["Levels of detail, each with half of the triangles","Detailstufen, jede mit halb so vielen Dreiecken","Niveaux de d\xE9tail, chacun avec la moiti\xE9 des triangles"],"levels.none":["one","eine","un seul"],"level.told":["{n} triangles","{n} Dreiecke","{n} triangles"],"level.away":["distance {d}","Abstand {d}","\xE9cart {d}"],"level.short":["no fewer are possible","weniger geht nicht","pas moins possible"],simplify:["Triangles to keep","Dreiecke behalten","Triangles \xE0 garder"],"simplify.all":["all","alle","tous"],"simplify.share":["{p}, about {n}","{p}, etwa {n}","{p}, environ {n}"],result:["Result","Ergebnis","R\xE9sultat"],download:["Download","Herunterladen","T\xE9l\xE9charger"],format:["Format","Format","Format"],"format.same":["{f}, as the file","{f}, wie die Datei","{f}, comme le fichier"],report:["Report for the customer","Bericht f\xFCr den Kunden","Rapport pour le client"],"report.json":["Report for programs","Bericht f\xFCr Programme","Rapport pour logiciels"],certificate:["Certificate","Zertifikat","Certificat"],"certificate.partial":["Checks of the file","Pr\xFCfung der Datei","Contr\xF4les du fichier"],"certificate.save":["Save","Speichern","Enregistrer"],hash:["SHA-256 of the certified file","SHA-256 der zertifizierten Datei","SHA-256 du fichier certifi\xE9"],"hash.partial":["SHA-256 of the file","SHA-256 der Datei","SHA-256 du fichier"],copy:["Copy","Kopieren","Copier"],"copy.curl":["Copy as curl","Als curl kopieren","Copier en curl"],copied:["Copied","Kopiert","Copi\xE9"],"changed.steps":["What was done","Was getan wurde","Ce qui a \xE9t\xE9 fait"],done:["{x}: {n}","{x}: {n}","{x} : {n}"],deviation:["Largest distance from the file","Gr\xF6\xDFter Abstand von der Datei","Plus grande distance du fichier"],volume:["Volume","Volumen","Volume"],verify:["Verify a file","Datei pr\xFCfen","V\xE9rifier un fichier"],"verify.more":["Drop any file here: is it the certified one, and is it valid?","Beliebige Datei hier ablegen: Ist es die zertifizierte, und ist sie g\xFCltig?","D\xE9posez un fichier : est-ce celui certifi\xE9, et est-il valide ?"],"verify.same":["This is the certified file, byte for byte.","Das ist die zertifizierte Datei, Byte f\xFCr Byte.","C\u2019est le fichier certifi\xE9, octet par octet."],"verify.other":["This is not the certified file: its bytes differ.","Das ist nicht die zertifizierte Datei: Die Bytes sind andere.","Ce n\u2019est pas le fichier certifi\xE9 : les octets diff\xE8rent."],"verify.more.partial":["Drop any file here: is it this one, and is it valid?","Beliebige Datei hier ablegen: Ist es diese, und ist sie g\xFCltig?","D\xE9posez un fichier : est-ce celui-ci, et est-il valide ?"],"verify.same.partial":["This is that file, byte for byte.","Das ist diese Datei, Byte f\xFCr Byte.","C\u2019est ce fichier, octet par octet."],"verify.other.partial":["This is not that file: its bytes differ.","Das ist nicht diese Datei: Die Bytes sind andere.","Ce n\u2019est pas ce fichier : les octets diff\xE8rent."],"verify.valid":["It is a valid solid, proved again just now.","Sie ist ein g\xFCltiger K\xF6rper, soeben neu bewiesen.","C\u2019est un solide valide, prouv\xE9 \xE0 l\u2019instant."],"verify.invalid":["It is not a valid solid.","Sie ist kein g\xFCltiger K\xF6rper.","Ce n\u2019est pas un solide valide."],"view.before":["Before","Vorher","Avant"],"view.after":["After","Nachher","Apr\xE8s"],"view.slider":["Slider","Schieber","Curseur"],"view.beside":["Side by side","Nebeneinander","C\xF4te \xE0 c\xF4te"],"view.compare":["Before and after","Vorher und nachher","Avant et apr\xE8s"],"view.divider":["Border between before and after","Grenze zwischen vorher und nachher","Limite entre avant et apr\xE8s"],"view.fit":["Fit","Einpassen","Ajuster"],"view.front":["Front","Vorne","Face"],"view.right":["Right","Rechts","Droite"],"view.back":["Back","Hinten","Arri\xE8re"],"view.left":["Left","Links","Gauche"],"view.top":["Top","Oben","Dessus"],"view.bottom":["Bottom","Unten","Dessous"],"view.iso":["Iso","Iso","Iso"],"view.standard":["Standard views","Standardansichten","Vues standard"],"view.smooth":["Smooth","Glatt","Lisse"],"view.edges":["Edges","Kanten","Ar\xEAtes"],"view.backs":["Back faces","R\xFCckseiten","Faces arri\xE8re"],"view.grid":["Bed","Druckbett","Plateau"],"view.section":["Section","Schnitt","Coupe"],"view.section.at":["Place of the section","Lage des Schnitts","Position de la coupe"],"view.section.axis":["Direction of the section","Richtung des Schnitts","Direction de la coupe"],"view.color":["Colours","Farben","Couleurs"],"color.file":["Colours of the file","Farben der Datei","Couleurs du fichier"],"color.plain":["One colour","Einfarbig","Une couleur"],"color.kept":["Kept and new","Behalten und neu","Gard\xE9 et nouveau"],"color.deviation":["Deviation","Abweichung","\xC9cart"],"color.thickness":["Wall thickness","Wandst\xE4rke","\xC9paisseur"],"legend.kept":["kept","behalten","gard\xE9"],"legend.new":["new","neu","nouveau"],"legend.gone":["gone","entfallen","supprim\xE9"],"legend.unmeasured":["not measured: stray pieces, and where no wall is opposite","nicht gemessen: lose St\xFCcke, und wo keine Wand gegen\xFCberliegt","non mesur\xE9 : morceaux isol\xE9s, et l\xE0 o\xF9 aucune paroi n\u2019est en face"],"legend.about":["approximate","ungef\xE4hr","approximatif"],"view.picture":["Picture of the part. Arrow keys turn it, plus and minus zoom, F fits, N and P go from place to place.","Bild des Teils. Pfeiltasten drehen, Plus und Minus zoomen, F passt ein, N und P gehen von Stelle zu Stelle.","Image de la pi\xE8ce. Les fl\xE8ches la tournent, plus et moins zooment, F ajuste, N et P vont d\u2019un endroit \xE0 l\u2019autre."],"view.no.webgl":["This browser shows no 3D. All else works.","Dieser Browser zeigt kein 3D. Alles andere geht.","Ce navigateur n\u2019affiche pas la 3D. Tout le reste marche."],"view.textured":["Textures and materials in other files are not drawn.","Texturen und Materialien aus anderen Dateien werden nicht gezeichnet.","Les textures et les mat\xE9riaux d\u2019autres fichiers ne sont pas dessin\xE9s."],"view.far":["{n} triangles lie far away from the part. A click on a finding shows them.","{n} Dreiecke liegen weit weg vom Teil. Ein Klick auf einen Befund zeigt sie.","{n} triangles sont loin de la pi\xE8ce. Un clic sur un constat les montre."],"view.far.one":["A triangle lies far away from the part. A click on a finding shows it.","Ein Dreieck liegt weit weg vom Teil. Ein Klick auf einen Befund zeigt es.","Un triangle est loin de la pi\xE8ce. Un clic sur un constat le montre."],"view.coarse":["While it moves, {n} of {m} triangles are drawn.","In Bewegung werden {n} von {m} Dreiecken gezeichnet.","En mouvement, {n} triangles sur {m} sont dessin\xE9s."],"view.rough":["While it moves, the picture is rougher: no graphics card draws it.","In Bewegung ist das Bild gr\xF6ber: Keine Grafikkarte zeichnet es.","En mouvement, l\u2019image est plus grossi\xE8re : aucune carte graphique ne la dessine."],"view.working":["Computing\u2026","Wird berechnet\u2026","Calcul\u2026"],jobs:["Jobs","Auftr\xE4ge","T\xE2ches"],"jobs.none":["None yet.","Noch keine.","Aucune."],"jobs.forget":["Forget the list","Liste vergessen","Oublier la liste"],"status.reading":["Reading the file","Datei lesen","Lecture du fichier"],"status.sending":["Sending","Senden","Envoi"],"status.queued":["Waiting for its turn","Wartet, bis es dran ist","En attente de son tour"],"status.done":["Done","Fertig","Termin\xE9"],"status.fetching":["Fetching the result","Ergebnis holen","R\xE9cup\xE9ration du r\xE9sultat"],key:["API key","API-Schl\xFCssel","Cl\xE9 d\u2019API"],"key.use":["Use it","Verwenden","Utiliser"],detail:["In the words of the service","In den Worten des Dienstes","Dans les mots du service"],dismiss:["Dismiss","Schlie\xDFen","Fermer"],language:["Language","Sprache","Langue"],theme:["Light or dark","Hell oder dunkel","Clair ou sombre"],docs:["API","API","API"],licences:["Licences","Lizenzen","Licences"],panel:["File and findings","Datei und Befunde","Fichier et constats"]};var Bc={"defect.no-triangle":["No surface at all","Gar keine Oberfl\xE4che","Aucune surface"],"defect.non-finite-vertex":["Points without a proper position","Punkte ohne g\xFCltige Position","Points sans position valable"],"defect.non-finite-face":["Faces at points without a proper position","Fl\xE4chen an Punkten ohne g\xFCltige Position","Faces sur des points sans position valable"],"defect.index-out-of-range":["Faces that name missing points","Fl\xE4chen, deren Punkte fehlen","Faces dont des points manquent"],"defect.too-few-corners":["Faces with fewer than three corners","Fl\xE4chen mit weniger als drei Ecken","Faces de moins de trois coins"],"defect.non-planar-polygon":["Faces that are not flat","Fl\xE4chen, die nicht eben sind","Faces qui ne sont pas planes"],"defect.concave-polygon":["Faces with notches","Fl\xE4chen mit Einbuchtungen","Faces avec des encoches"],"defect.coincident-corners":["Faces with two corners at one place","Fl\xE4chen mit zwei Ecken am selben Ort","Faces avec deux coins au m\xEAme endroit"],"defect.collinear-face":["Faces as thin as a line","Fl\xE4chen, d\xFCnn wie eine Linie","Faces r\xE9duites \xE0 une ligne"],"defect.needle":["Faces as thin as needles","Nadeld\xFCnne Fl\xE4chen","Faces fines comme des aiguilles"],"defect.cap":["Faces almost as thin as a line","Fast zur Linie flache Fl\xE4chen","Faces presque r\xE9duites \xE0 une ligne"],"defect.duplicate-face":["Faces that are there twice","Doppelte Fl\xE4chen","Faces en double"],"defect.opposite-duplicate-face":["Walls with two sides and nothing between","W\xE4nde aus zwei Seiten und nichts dazwischen","Parois \xE0 deux faces sans rien entre elles"],"defect.isolated-vertex":["Points that belong to no face","Punkte ohne Fl\xE4che","Points sans face"],"defect.isolated-edge":["Lines that belong to no face","Linien ohne Fl\xE4che","Lignes sans face"],"defect.duplicate-vertex":["Points that are there twice","Doppelte Punkte","Points en double"],"defect.isolated-face":["Faces that hang in the air","Fl\xE4chen, die frei schweben","Faces flottantes"],"defect.boundary-loop":["Holes and open rims","L\xF6cher und offene R\xE4nder","Trous et bords ouverts"],"defect.non-manifold-edge":["Edges where more than two faces meet","Kanten, an denen mehr als zwei Fl\xE4chen liegen","Ar\xEAtes o\xF9 plus de deux faces se rejoignent"],"defect.non-manifold-vertex":["Points where parts touch in nothing else","Punkte, in denen sich Teile nur ber\xFChren","Points o\xF9 des parties ne font que se toucher"],"defect.orientation-conflict":["Neighbours that disagree which side is outside","Nachbarn, die sich \xFCber au\xDFen uneins sind","Voisines en d\xE9saccord sur l\u2019ext\xE9rieur"],"defect.non-orientable":["A surface with one side only","Eine Fl\xE4che mit nur einer Seite","Une surface \xE0 une seule face"],"defect.folded-edge":["Faces folded onto each other","Aufeinander gefaltete Fl\xE4chen","Faces repli\xE9es l\u2019une sur l\u2019autre"],"defect.inverted-shell":["Parts that are inside out","Umgest\xFClpte Teile","Parties retourn\xE9es"],"defect.misnested-shell":["Parts hidden inside others","Teile, die in anderen stecken","Parties cach\xE9es dans d\u2019autres"],"defect.zero-volume-shell":["Parts that enclose nothing","Teile, die nichts umschlie\xDFen","Parties qui n\u2019enferment rien"],"defect.double-skin":["Two sides with next to nothing between","Zwei Seiten mit fast nichts dazwischen","Deux faces presque confondues"],"defect.open-sheet":["Surfaces without thickness","Fl\xE4chen ohne Dicke","Surfaces sans \xE9paisseur"],"defect.noise-shell":["Tiny stray parts","Winzige lose Teile","Minuscules parties isol\xE9es"],"defect.self-intersection":["Surfaces that pass through each other","Fl\xE4chen, die sich durchdringen","Surfaces qui se traversent"],"defect.overlap":["Surfaces that lie on each other","Fl\xE4chen, die aufeinander liegen","Surfaces superpos\xE9es"],"defect.touch":["Surfaces that touch","Fl\xE4chen, die sich ber\xFChren","Surfaces qui se touchent"],"defect.near":["Surfaces that almost touch","Fl\xE4chen, die sich fast ber\xFChren","Surfaces qui se touchent presque"],"defect.unsound-reading":["Sound only for some programs","Nur f\xFCr manche Programme in Ordnung","Correct pour certains logiciels seulement"],"severity.error":["must be mended","muss behoben werden","\xE0 r\xE9parer"],"severity.warning":["worth a look","einen Blick wert","\xE0 regarder"],"severity.info":["good to know","gut zu wissen","bon \xE0 savoir"],"hole.crack":["a crack","ein Riss","une fissure"],"hole.missing-face":["a missing face","eine fehlende Fl\xE4che","une face manquante"],"hole.planar-cut":["a flat hole","ein ebenes Loch","un trou plan"],"hole.missing-region":["a missing region","ein fehlendes St\xFCck","une r\xE9gion manquante"],"hole.intended-opening":["an opening, perhaps meant","eine \xD6ffnung, vielleicht gewollt","une ouverture, peut-\xEAtre voulue"],"remedy.drop":["drop","weglassen","supprimer"],"remedy.drop-both":["drop both","beide weglassen","supprimer les deux"],"remedy.drop-one":["drop one","eine weglassen","en supprimer une"],"remedy.collapse":["collapse the short edge","kurze Kante schlie\xDFen","contracter l\u2019ar\xEAte courte"],"remedy.flip":["flip the long edge","lange Kante wenden","basculer l\u2019ar\xEAte longue"],"remedy.split":["divide","teilen","diviser"],"remedy.join":["join","verbinden","joindre"],"remedy.fill":["close","schlie\xDFen","boucher"],"remedy.thicken":["give it a wall","Wandst\xE4rke geben","donner une \xE9paisseur"],"remedy.cut":["cut apart","trennen","s\xE9parer"],"remedy.turn":["turn","wenden","retourner"],"remedy.remove":["remove","entfernen","enlever"],"remedy.unite":["unite the bodies","K\xF6rper vereinen","unir les corps"],"remedy.round":["round coordinates","Koordinaten runden","arrondir les coordonn\xE9es"],"remedy.rebuild":["rebuild the surface","Oberfl\xE4che neu aufbauen","reconstruire la surface"],"remedy.keep":["leave as it is","so lassen","laisser tel quel"],"method.auto":["as fits best","wie es am besten passt","au mieux"],"method.flat":["flat","eben","\xE0 plat"],"method.minimal":["least area","kleinste Fl\xE4che","aire minimale"],"method.smooth":["smoothly","glatt","en douceur"],"method.creased":["with its creases","mit Knicken","avec ses plis"],"method.rbf":["fitted to what is around","der Umgebung angepasst","ajust\xE9 aux alentours"],"outcome.identical":["It was sound already: the same bytes come back.","Die Datei war schon in Ordnung: dieselben Bytes kommen zur\xFCck.","Le fichier \xE9tait d\xE9j\xE0 correct : les m\xEAmes octets reviennent."],"outcome.converted":["It was sound, and is written in another format.","Die Datei war in Ordnung und ist in ein anderes Format geschrieben.","Le fichier \xE9tait correct ; il est \xE9crit dans un autre format."],"outcome.repaired":["Mended in a few places.","An einzelnen Stellen repariert.","R\xE9par\xE9 en quelques endroits."],"outcome.rebuilt":["The surface was rebuilt: mending single places was not enough.","Die Oberfl\xE4che wurde neu aufgebaut: Einzelne Stellen zu reparieren reichte nicht.","La surface a \xE9t\xE9 reconstruite : r\xE9parer localement ne suffisait pas."],"outcome.combined":["Made of several files.","Aus mehreren Dateien gemacht.","Fait de plusieurs fichiers."],"outcome.simplified":["Written with fewer triangles.","Mit weniger Dreiecken geschrieben.","\xC9crit avec moins de triangles."],"outcome.partial":["The best there is, although it is not sound.","Das Beste, was geht, aber nicht in Ordnung.","Le mieux possible, bien que non valide."],"outcome.refused":["No result: nothing was found that is proved to be sound.","Kein Ergebnis: Nichts gefunden, was bewiesen in Ordnung ist.","Pas de r\xE9sultat : rien dont la validit\xE9 soit prouv\xE9e."],"fidelity.exact":["Its surface is exactly that of your file.","Die Oberfl\xE4che ist genau die Ihrer Datei.","Sa surface est exactement celle de votre fichier."],"fidelity.faithful":["Nothing visible was lost, made up or moved beyond small limits.","Nichts Sichtbares ging \xFCber kleine Grenzen hinaus verloren, kam hinzu oder wurde verschoben.","Rien de visible n\u2019a \xE9t\xE9 perdu, invent\xE9 ou d\xE9plac\xE9 au-del\xE0 de petites limites."],"fidelity.changed":["It is not the same as your file:","Es ist nicht dasselbe wie Ihre Datei:","Ce n\u2019est pas la m\xEAme chose que votre fichier :"],"change.lost":["{a} of the visible surface is lost (allowed: {b})","{a} der sichtbaren Oberfl\xE4che fehlen (erlaubt: {b})","{a} de la surface visible est perdue (permis : {b})"],"change.invented":["{a} of the surface is made up (allowed: {b})","{a} der Oberfl\xE4che sind erfunden (erlaubt: {b})","{a} de la surface est invent\xE9e (permis : {b})"],"change.moved":["up to {a} away from the file (allowed: {b})","bis zu {a} von der Datei entfernt (erlaubt: {b})","jusqu\u2019\xE0 {a} du fichier (permis : {b})"],"change.bodies":["{a} bodies are lost","{a} K\xF6rper fehlen","{a} corps perdus"],"change.bodies.one":["one body is lost","ein K\xF6rper fehlt","un corps perdu"],"change.volume":["the volume changed by {a} (allowed: {b})","das Volumen \xE4nderte sich um {a} (erlaubt: {b})","le volume a chang\xE9 de {a} (permis : {b})"],"done.triangles_added":["triangles added","Dreiecke hinzugef\xFCgt","triangles ajout\xE9s"],"done.triangles_dropped":["triangles dropped","Dreiecke weggelassen","triangles supprim\xE9s"],"done.triangles_flipped":["triangles turned","Dreiecke gewendet","triangles retourn\xE9s"],"done.triangles_split":["triangles divided","Dreiecke geteilt","triangles divis\xE9s"],"done.triangles_copied":["triangles copied","Dreiecke verdoppelt","triangles copi\xE9s"],"done.triangles_before":["triangles before","Dreiecke vorher","triangles avant"],"done.triangles_after":["triangles after","Dreiecke nachher","triangles apr\xE8s"],"done.vertices_added":["points added","Punkte hinzugef\xFCgt","points ajout\xE9s"],"done.vertices_joined":["points joined","Punkte verbunden","points joints"],"done.vertices_moved":["points moved","Punkte verschoben","points d\xE9plac\xE9s"],"done.vertices_copied":["points copied","Punkte verdoppelt","points copi\xE9s"],"done.unused_vertices_dropped":["points without a face dropped","Punkte ohne Fl\xE4che weggelassen","points sans face supprim\xE9s"],"done.unusable_faces_dropped":["unusable faces dropped","unbrauchbare Fl\xE4chen weggelassen","faces inutilisables supprim\xE9es"],"done.polygons_split":["faces divided into triangles","Fl\xE4chen in Dreiecke geteilt","faces divis\xE9es en triangles"],"done.edges_joined":["edges joined","Kanten verbunden","ar\xEAtes jointes"],"done.edges_divided":["edges divided","Kanten geteilt","ar\xEAtes divis\xE9es"],"done.edges_collapsed":["edges contracted","Kanten zusammengezogen","ar\xEAtes contract\xE9es"],"done.edges_paired":["edges paired","Kanten zu Paaren gemacht","ar\xEAtes appari\xE9es"],"done.faces_removed":["faces removed by simplifying","Fl\xE4chen beim Vereinfachen entfernt","faces enlev\xE9es en simplifiant"],"done.holes_filled":["holes closed","L\xF6cher geschlossen","trous bouch\xE9s"],"done.holes_left":["holes left open","L\xF6cher offen gelassen","trous laiss\xE9s ouverts"],"done.rims_spanned":["rims spanned","R\xE4nder \xFCberspannt","bords reli\xE9s"],"done.sheets_thickened":["surfaces given a wall","Fl\xE4chen mit Wandst\xE4rke versehen","surfaces \xE9paissies"],"done.shells_turned":["parts turned","Teile gewendet","parties retourn\xE9es"],"done.copies_dropped":["copies dropped","Kopien weggelassen","copies supprim\xE9es"],"done.parts_removed":["parts removed","Teile entfernt","parties enlev\xE9es"],"done.part_triangles_removed":["triangles of removed parts","Dreiecke entfernter Teile","triangles des parties enlev\xE9es"],"done.open_parts_closed":["open parts closed","offene Teile geschlossen","parties ouvertes ferm\xE9es"],"stage.read":["Reading","Lesen","Lecture"],"stage.analyze":["Looking for defects","Fehler suchen","Recherche des d\xE9fauts"],"stage.repair":["Repairing","Reparieren","R\xE9paration"],"stage.simplify":["Simplifying","Vereinfachen","Simplification"],"stage.write":["Writing","Schreiben","\xC9criture"],"stage.certify":["Proving","Beweisen","Preuve"],"stage.measure":["Measuring","Messen","Mesure"],"stage.draw":["Drawing","Zeichnen","Dessin"],"check.wall-thickness":["Wall thickness","Wandst\xE4rke","\xC9paisseur des parois"],"check.gap":["Gaps","Spalte","Jeux"],"check.small-feature":["Small parts","Kleine Teile","Petits d\xE9tails"],"check.overhang":["Overhangs","\xDCberh\xE4nge","Surplombs"],"check.sharp-edge":["Sharp edges","Scharfe Kanten","Ar\xEAtes vives"],"check.trapped-cavity":["Trapped cavities","Eingeschlossene Hohlr\xE4ume","Cavit\xE9s ferm\xE9es"],"check.build-volume":["Size","Gr\xF6\xDFe","Taille"],"operation.plan":["looked at","angesehen","examin\xE9"],"operation.boolean":["combined","verbunden","combin\xE9"],"operation.repair":["repaired","repariert","r\xE9par\xE9"],"state.queued":["waiting","wartet","en attente"],"state.running":["running","l\xE4uft","en cours"],"state.succeeded":["done","fertig","termin\xE9"],"state.failed":["no result","kein Ergebnis","sans r\xE9sultat"],"state.cancelled":["cancelled","abgebrochen","annul\xE9"],"state.expired":["expired","abgelaufen","expir\xE9"],"problem.mesh-unparseable":["This file cannot be read. Export it again, if possible as STL or OBJ.","Diese Datei ist nicht lesbar. Exportieren Sie sie erneut, am besten als STL oder OBJ.","Ce fichier est illisible. Exportez-le \xE0 nouveau, si possible en STL ou OBJ."],"problem.mesh-truncated":["The file ends too early. It may not have been saved or sent completely: export it again.","Die Datei endet zu fr\xFCh. Vielleicht wurde sie nicht ganz gespeichert: Exportieren Sie sie erneut.","Le fichier s\u2019arr\xEAte trop t\xF4t. Il n\u2019a peut-\xEAtre pas \xE9t\xE9 enregistr\xE9 en entier : exportez-le \xE0 nouveau."],"problem.mesh-empty":["There is no mesh in this file. Check what you exported.","In dieser Datei ist kein Netz. Pr\xFCfen Sie, was exportiert wurde.","Ce fichier ne contient pas de maillage. V\xE9rifiez ce qui a \xE9t\xE9 export\xE9."],"problem.mesh-non-finite":["Some points have no proper position. Export the file again.","Einige Punkte haben keine g\xFCltige Position. Exportieren Sie die Datei erneut.","Des points n\u2019ont pas de position valable. Exportez le fichier \xE0 nouveau."],"problem.mesh-too-large":["The mesh is larger than this service takes. Simplify it before, or ask the operator for more.","Das Netz ist gr\xF6\xDFer, als dieser Dienst annimmt. Vereinfachen Sie es vorher, oder fragen Sie den Betreiber.","Le maillage d\xE9passe ce que ce service accepte. Simplifiez-le avant, ou demandez \xE0 l\u2019exploitant."],"problem.body-too-large":["The file is larger than this service takes. Save it in a binary format, or simplify it.","Die Datei ist gr\xF6\xDFer, als dieser Dienst annimmt. Speichern Sie sie bin\xE4r, oder vereinfachen Sie sie.","Le fichier d\xE9passe ce que ce service accepte. Enregistrez-le en binaire, ou simplifiez-le."],"problem.unsupported-media-type":["This kind of file is not read here. Export it as STL, OBJ, PLY, OFF, 3MF or GLB.","Diese Art von Datei wird hier nicht gelesen. Exportieren Sie sie als STL, OBJ, PLY, OFF, 3MF oder GLB.","Ce type de fichier n\u2019est pas lu ici. Exportez-le en STL, OBJ, PLY, OFF, 3MF ou GLB."],"problem.not-repairable":["No result was found that is proved to be sound. Change what is done about the findings, or take the best there is.","Es wurde kein bewiesen fehlerfreies Ergebnis gefunden. \xC4ndern Sie, was mit den Befunden geschieht, oder nehmen Sie das Beste, was geht.","Aucun r\xE9sultat prouv\xE9 valide. Changez ce qui est fait des constats, ou acceptez le meilleur possible."],"problem.over-budget":["No result was found in the work that a file of this size may take. Simplify the mesh, or repair its parts one by one.","In der Arbeit, die eine Datei dieser Gr\xF6\xDFe kosten darf, wurde kein Ergebnis gefunden. Vereinfachen Sie das Netz, oder reparieren Sie seine Teile einzeln.","Aucun r\xE9sultat n\u2019a \xE9t\xE9 trouv\xE9 dans le travail permis pour un fichier de cette taille. Simplifiez le maillage, ou r\xE9parez ses parties une \xE0 une."],"problem.input-not-solid":["One of the files is no closed solid. Open and repair it by itself before.","Eine der Dateien ist kein geschlossener K\xF6rper. \xD6ffnen und reparieren Sie sie vorher einzeln.","Un des fichiers n\u2019est pas un solide ferm\xE9. Ouvrez-le et r\xE9parez-le seul d\u2019abord."],"problem.empty-result":["Nothing would be left. Choose another operation, or another order of the files.","Es bliebe nichts \xFCbrig. W\xE4hlen Sie anders, oder ordnen Sie die Dateien anders.","Il ne resterait rien. Choisissez une autre op\xE9ration ou un autre ordre."],"problem.not-combined":["The files are too much entangled to be combined.","Die Dateien sind zu sehr verwickelt, um verbunden zu werden.","Les fichiers sont trop enchev\xEAtr\xE9s pour \xEAtre combin\xE9s."],"problem.too-many-files":["At most 32 files can become one. Choose fewer.","H\xF6chstens 32 Dateien k\xF6nnen eine werden. W\xE4hlen Sie weniger.","32 fichiers au plus peuvent n\u2019en faire qu\u2019un. Choisissez-en moins."],"problem.plan-mismatch":["The choices do not fit this file. Drop it again to begin anew.","Die Auswahl passt nicht zu dieser Datei. Legen Sie sie noch einmal ab.","Les choix ne correspondent pas \xE0 ce fichier. D\xE9posez-le \xE0 nouveau."],"problem.expired":["This job is kept no longer. Drop the file again.","Dieser Auftrag ist nicht mehr gespeichert. Legen Sie die Datei noch einmal ab.","Cette t\xE2che n\u2019est plus conserv\xE9e. D\xE9posez le fichier \xE0 nouveau."],"problem.not-found":["There is no such job here (any more). Drop the file again.","Diesen Auftrag gibt es hier nicht (mehr). Legen Sie die Datei noch einmal ab.","Cette t\xE2che n\u2019existe pas (ou plus) ici. D\xE9posez le fichier \xE0 nouveau."],"problem.queue-full":["Too many jobs are waiting. Try again in a minute.","Zu viele Auftr\xE4ge warten. Versuchen Sie es in einer Minute wieder.","Trop de t\xE2ches attendent. R\xE9essayez dans une minute."],"problem.rate-limited":["Too many requests. Try again in a minute.","Zu viele Anfragen. Versuchen Sie es in einer Minute wieder.","Trop de requ\xEAtes. R\xE9essayez dans une minute."],"problem.unauthenticated":["This service wants a key. Enter it below.","Dieser Dienst verlangt einen Schl\xFCssel. Geben Sie ihn unten ein.","Ce service demande une cl\xE9. Saisissez-la ci-dessous."],"problem.forbidden":["The service does not answer this address. Ask its operator.","Der Dienst antwortet dieser Adresse nicht. Fragen Sie den Betreiber.","Le service ne r\xE9pond pas \xE0 cette adresse. Demandez \xE0 l\u2019exploitant."],"problem.cancelled":["Cancelled. Nothing was changed.","Abgebrochen. Nichts wurde ge\xE4ndert.","Annul\xE9. Rien n\u2019a \xE9t\xE9 chang\xE9."],"problem.engine-timeout":["It took longer than this service allows. Try a simpler file, or fewer choices.","Es dauerte l\xE4nger, als dieser Dienst erlaubt. Versuchen Sie eine einfachere Datei.","C\u2019\xE9tait plus long que ce service ne le permet. Essayez un fichier plus simple."],"problem.engine-out-of-memory":["The file needs more memory than this service allows. Simplify it before.","Die Datei braucht mehr Speicher, als dieser Dienst erlaubt. Vereinfachen Sie sie vorher.","Le fichier demande plus de m\xE9moire que permis. Simplifiez-le avant."],"problem.storage-full":["The service has no room for more files. Try again later.","Der Dienst hat keinen Platz f\xFCr weitere Dateien. Versuchen Sie es sp\xE4ter.","Le service n\u2019a plus de place. R\xE9essayez plus tard."],"problem.unreachable":["The service does not answer. Check the connection; the file is still here.","Der Dienst antwortet nicht. Pr\xFCfen Sie die Verbindung; die Datei ist noch hier.","Le service ne r\xE9pond pas. V\xE9rifiez la connexion ; le fichier est toujours l\xE0."],"problem.too-vast":["The coordinates are too large to be drawn. All else works.","Die Koordinaten sind zu gro\xDF, um gezeichnet zu werden. Alles andere geht.","Les coordonn\xE9es sont trop grandes pour \xEAtre dessin\xE9es. Tout le reste marche."],"problem.file-empty":["This file is empty: there is not one byte in it. Export it again.","Diese Datei ist leer: Sie hat kein einziges Byte. Exportieren Sie sie erneut.","Ce fichier est vide : il n\u2019a pas un seul octet. Exportez-le \xE0 nouveau."],"problem.archive-unsafe":["This archive breaks a rule of safety and is not unpacked. Save the project anew, or export it as STL.","Dieses Archiv verletzt eine Sicherheitsregel und wird nicht entpackt. Speichern Sie das Projekt neu, oder exportieren Sie es als STL.","Cette archive enfreint une r\xE8gle de s\xE9curit\xE9 et n\u2019est pas d\xE9compress\xE9e. Enregistrez le projet \xE0 nouveau, ou exportez-le en STL."],"problem.body-incomplete":["The file did not arrive whole. Check the connection, and try again.","Die Datei kam nicht ganz an. Pr\xFCfen Sie die Verbindung, und versuchen Sie es noch einmal.","Le fichier n\u2019est pas arriv\xE9 en entier. V\xE9rifiez la connexion et r\xE9essayez."],"problem.draining":["The service is stopping, or lost this job. Try again in a minute.","Der Dienst h\xE4lt gerade an, oder der Auftrag ging ihm verloren. Versuchen Sie es in einer Minute wieder.","Le service s\u2019arr\xEAte, ou a perdu cette t\xE2che. R\xE9essayez dans une minute."],"problem.engine-crashed":["The service failed on this file. Export it in another format, and tell the operator.","Der Dienst ist an dieser Datei gescheitert. Exportieren Sie sie in einem anderen Format, und sagen Sie es dem Betreiber.","Le service a \xE9chou\xE9 sur ce fichier. Exportez-le dans un autre format, et pr\xE9venez l\u2019exploitant."],"problem.unknown-parameter":["The page and the service do not understand each other. Reload the page; if it stays so, tell the operator.","Seite und Dienst verstehen sich nicht. Laden Sie die Seite neu; bleibt es so, sagen Sie es dem Betreiber.","La page et le service ne se comprennent pas. Rechargez la page ; si cela persiste, pr\xE9venez l\u2019exploitant."],"problem.other":["Something went wrong in the service. Try again; if it stays so, tell its operator.","Im Dienst ging etwas schief. Versuchen Sie es noch einmal; bleibt es so, sagen Sie es dem Betreiber.","Une erreur est survenue. R\xE9essayez ; si elle persiste, pr\xE9venez l\u2019exploitant."]},Qd={"body-incomplete":["upload-conflict","upload-unfinished","upload-timeout"],draining:["worker-lost","store-unavailable"],other:["internal"],"unknown-parameter":["invalid-parameter","unsupported-version","presigned-refused","method-not-allowed","not-acceptable","range-not-satisfiable","precondition-failed","head-too-large","job-not-finished","idempotency-key-reused","webhook-refused"]},kc=Object.fromEntries(Object.entries(Qd).flatMap(([i,e])=>e.map(t=>[t,i])));var gr=["en","de","fr"],zc={...Fc,...Bc},xs=ef();function ef(){return[tf(),...navigator.languages??[]].filter(Boolean).map(e=>e.slice(0,2)).find(e=>gr.includes(e))??"en"}function tf(){try{return localStorage.getItem("language")}catch{return null}}var ys=()=>xs;function Ua(i){xs=i;try{localStorage.setItem("language",i)}catch{}document.documentElement.lang=i}var ei=i=>i in zc;function Q(i,e={}){let t=zc[i]?.[gr.indexOf(xs)]??i.replace(/^\w+\./,"").replaceAll("-"," ");return nf(t.replace(/\{(\w+)\}/g,(n,s)=>e[s]??""))}var nf=i=>xs==="fr"?i.replace(/ (?=[:;?!%])/g,"\xA0"):i,Ei=(i,e,t={})=>Q(e===1&&ei(`${i}.one`)?`${i}.one`:i,{n:$e(e),...t}),$e=(i,e={})=>new Intl.NumberFormat(xs,{maximumFractionDigits:0,...e}).format(i),Dn=i=>$e(i,{style:"percent",maximumSignificantDigits:3}),Nn=(i,e=4)=>$e(i,{maximumFractionDigits:20,maximumSignificantDigits:e,notation:sf(Math.abs(i))?"scientific":"standard"}),sf=i=>i>=1e9||i>0&&i<1e-6,Un=i=>i>0&&i<.001?`< ${Nn(.001)} mm`:`${Nn(i)} mm`;function Gc(i){for(let e of i.querySelectorAll("[data-t]"))e.textContent=Q(e.dataset.t);for(let e of i.querySelectorAll("[data-t-label]"))e.setAttribute("aria-label",Q(e.dataset.tLabel)),e.title=Q(e.dataset.tLabel)}var B=i=>document.getElementById(i);function W(i,e={},...t){let n=document.createElement(i);for(let[s,r]of Object.entries(e))r!=null&&(s.startsWith("on")?n.addEventListener(s.slice(2),r):s.includes("-")||s==="for"||s==="role"||s==="lang"?n.setAttribute(s,r):n[s]=r);return n.append(...t.flat().filter(s=>s!=null&&s!==!1)),n}var Vc=!1,vr=()=>{Vc=document.activeElement!==document.body};function Fi(i){if(!Vc)return;let{activeElement:e}=document;(e===document.body||e.disabled||!e.checkVisibility())&&i?.focus({preventScroll:!0})}function ti(i,e,t,n={}){let s=i.map(([r,o])=>W("option",{value:r,selected:r===e},o));return W("select",{...n,onchange:r=>t(r.target.value)},s)}var ni=(i,e)=>W("label",{className:"field"},W("span",{},i),e);function Bi(i,e){let t=URL.createObjectURL(i);W("a",{href:t,download:e}).click(),setTimeout(()=>URL.revokeObjectURL(t),6e4)}function Oa(i,e){let t=W("button",{type:"button",className:"quiet",onclick:async()=>{await rf(e()),t.textContent=Q("copied"),setTimeout(()=>{t.textContent=i},1600)}},i);return t}async function rf(i){if(navigator.clipboard)return navigator.clipboard.writeText(i);let e=W("textarea",{value:i});document.body.append(e),e.select(),document.execCommand("copy"),e.remove()}var xr=(i,e)=>i[0]*e[0]+i[1]*e[1]+i[2]*e[2],Fa=(i,e)=>[i[0]-e[0],i[1]-e[1],i[2]-e[2]],Hc=(i,e)=>[i[1]*e[2]-i[2]*e[1],i[2]*e[0]-i[0]*e[2],i[0]*e[1]-i[1]*e[0]],Ba=(i,e)=>[i[e],i[e+1],i[e+2]];function Wc(i,e,t,n){let s=Ba(t,n),r=Fa(Ba(t,n+3),s),o=Fa(Ba(t,n+6),s),a=Hc(e,o),l=xr(r,a);if(l===0)return 1/0;let c=Fa(i,s),h=xr(c,a)/l;if(h<0||h>1)return 1/0;let d=Hc(c,r),u=xr(e,d)/l;return u<0||h+u>1?1/0:xr(o,d)/l}function qc(i,e){let t=[...Xc(i,e),...Xc(e,i)],n=[],s=0;for(let r of t)for(let o of t){let a=Math.hypot(r[0]-o[0],r[1]-o[1],r[2]-o[2]);a>s&&([s,n]=[a,[...r,...o]])}return n}function*Xc(i,e){for(let t=0;t<9;t+=3){let n=[0,1,2].map(o=>i[t+o]),s=[0,1,2].map(o=>i[(t+3)%9+o]-n[o]),r=Wc(n,s,e,0);r>=0&&r<=1&&(yield n.map((o,a)=>o+r*s[a]))}}var Yc=([i,e,t],n)=>[0,1,2].map(s=>i*n[s]+e*n[3+s]+t*n[6+s]+n[9+s]);var Ss=class{constructor({objects:e,order:t}){this.objects=e,this.order=t,this.parts=[],this.count=t.reduce((n,s)=>n+e[s].count,0),this.isWhole=!0}setParts(e,t=this.count){this.isWhole=t===this.count,this.parts=e.map((n,s)=>{let r=n.first_face-e.find(a=>a.path===n.path&&a.object===n.object).first_face,o=this.objects.find(({path:a,id:l,from:c,count:h})=>a.toLowerCase()===n.path.toLowerCase()&&l===n.object&&c<=r&&r<c+h);return{object:o,from:n.first_face,until:e[s+1]?.first_face??1/0,inObject:r-o?.from}})}partOf(e){return this.parts.length===1?this.parts[0]:this.parts.find(({from:t,until:n})=>t<=e&&e<n)}face(e){if(this.parts.length){let n=this.partOf(e);return n?.object?n.object.first+n.inObject+e-n.from:-1}if(!this.isWhole)return-1;let t=e;for(let n of this.order){let{first:s,count:r}=this.objects[n];if(t<r)return s+t;t-=r}return-1}placed(e,t){if(this.parts.length===0)return e;let n=this.partOf(t)?.object?.places[0];return n?Yc(e,n):null}trianglesOf(e,t){let{object:n,from:s,until:r,inObject:o}=this.parts[e];if(!n)return[];let a=n.first+o,l=Math.min(n.first+n.count,a+r-s),c=[];return t.forEach((h,d)=>{h>=a&&h<l&&t[d-1]!==h&&c.push(d)}),c}},$c=new Ss({objects:[],order:[]});var yr=class{constructor({project:e,...t}){Object.assign(this,t),this.project=e?new Ss(e):null}trianglesOf(e,t=!1){let n=this.project?this.project.face(e):e,[s,r]=[0,this.faceOf.length];for(;s<r;){let a=s+r>>1;this.faceOf[a]<n?s=a+1:r=a}let o=[];for(;this.faceOf[s]===n;s+=1)o.push(s);return t&&this.project?o.slice(0,1):o}facesAt(e,t){return e.flatMap(n=>this.trianglesOf(n,t)).flatMap(n=>this.cornersOf(n))}cornersOf(e){return[...this.positions.subarray(e*9,e*9+9)]}place(e,t,n){let s=this.project?this.project.placed(e,n):e;return s&&s.map((r,o)=>r*t-this.origin[o])}whereIs(e){let t=this.project?.trianglesOf(e,this.faceOf);if(!t?.length)return null;let[n,s]=[[1/0,1/0,1/0],[-1/0,-1/0,-1/0]];for(let o of t)for(let a=0;a<9;a+=1){let l=this.positions[o*9+a];l<n[a%3]&&(n[a%3]=l),l>s[a%3]&&(s[a%3]=l)}let r=t[0]<this.drawn?null:{segments:[],faces:t.flatMap(o=>this.cornersOf(o)),points:[]};return{place:n.map((o,a)=>(o+s[a])/2),radius:Math.hypot(...n.map((o,a)=>s[a]-o))/2,undrawn:r}}rimAt(e,t){if(!this.rims)return[];this.rimNumbers??=lf(this.rims);let n=new Set,s=new Set(e.flatMap(r=>this.trianglesOf(r,t)));return this.rims.halves.forEach((r,o)=>{s.has(Math.floor(r/3))&&n.add(this.rimNumbers[o])}),[...this.rimNumbers.keys()].filter(r=>n.has(this.rimNumbers[r])).flatMap(r=>[...this.edges.open.subarray(r*6,r*6+6)])}partsOf(e,t,n,s=!1){let r=t.faces.map(({index:c})=>c),o=e==="boundary-loop"?this.rimAt(r,s):e==="self-intersection"?this.crossingOf(r,s):[],a=e==="boundary-loop"&&o.length?[]:this.facesAt(r,s),l=!o.length&&!a.length&&t.position?this.place(t.position,n,r[0])??[]:[];return{segments:o,faces:a,points:l}}crossingOf(e,t){let[n,s]=e.map(r=>this.facesAt([r],t));return!n?.length||n.length!==s?.length?[]:n.flatMap((r,o)=>o%9?[]:qc(n.slice(o,o+9),s.slice(o,o+9)))}overlayOf(e,t){let n={"boundary-loop":"open","non-manifold-edge":"crowded","orientation-conflict":"turned"}[e.code];if(n&&this.edges?.[n].length)return{segments:this.edges[n]};let s=e.witnesses.map(o=>this.partsOf(e.code,o,t)),r=s.flatMap(o=>o.segments.length?[]:o.faces);return{segments:s.flatMap(o=>o.segments),faces:r,points:s.flatMap(o=>o.points)}}};function lf({ends:i,others:e}){let t=new Map,n=(r,o)=>t.set(r,[...t.get(r)??[],o]);i.forEach((r,o)=>n(r,o)),e.forEach((r,o)=>n(r,o));let s=new Int32Array(i.length).fill(-1);for(let r=0;r<i.length;r+=1){let o=s[r]<0?[r]:[];for(;o.length;){let a=o.pop();s[a]>=0||(s[a]=r,o.push(...t.get(i[a]),...t.get(e[a])))}}return s}function Ms({segments:i,faces:e,points:t},n){let s=[i,e,t].find(c=>c.length)??n,r=[0,0,0];for(let c=0;c<s.length;c+=1)r[c%3]+=s[c]*3/s.length;let o=0;for(let c=0;c<s.length;c+=3)o=Math.max(o,Math.hypot(...r.map((h,d)=>s[c+d]-h)));let a=[0,0,0];for(let c=0;c<e.length;c+=9){let[h,d]=[3,6].map(u=>[0,1,2].map(f=>e[c+u+f]-e[c+f]));[h[1]*d[2]-h[2]*d[1],h[2]*d[0]-h[0]*d[2],h[0]*d[1]-h[1]*d[0]].forEach((u,f)=>{a[f]+=u})}let l=Math.hypot(...a);return{place:r,radius:o,normal:l>0?a.map(c=>c/l):r}}var cf={light:{base:"#b9c2cb",edge:"#3b4651",kept:"#b9c2cb",fresh:"#1f9e86",gone:"#e0882f",cut:"#6d7c8c",grid:"#8b97a3",back:"#cf3f36"},dark:{base:"#93a0ad",edge:"#10151a",kept:"#8a97a4",fresh:"#2fbf9f",gone:"#f09a45",cut:"#55636f",grid:"#5a6672",back:"#e2574d"}},hf={"boundary-loop":"#f2731c","open-sheet":"#f2a51c","isolated-face":"#f2a51c","non-manifold-edge":"#a83ad0","non-manifold-vertex":"#a83ad0","non-orientable":"#3a63d0","orientation-conflict":"#2f7fe0","inverted-shell":"#2f7fe0","misnested-shell":"#3a63d0","self-intersection":"#e0357f",overlap:"#e0357f",touch:"#e0609a",near:"#e0609a",needle:"#0c9ab0",cap:"#0c9ab0","folded-edge":"#0c9ab0","collinear-face":"#0c9ab0","coincident-corners":"#0c9ab0"},Zc=["#3b6fb6","#9ccbe0","#f3c35b","#d0342c"],ka=i=>cf[i],ki=i=>hf[i]??"#8a6d1c",wn=i=>[1,3,5].map(e=>parseInt(i.slice(e,e+2),16)/255);var gi={LEFT:0,MIDDLE:1,RIGHT:2,ROTATE:0,DOLLY:1,PAN:2},vi={ROTATE:0,PAN:1,DOLLY_PAN:2,DOLLY_ROTATE:3},wh=0,fl=1,Eh=2;var Zs=1,Ah=2,cs=3,Rn=0,Nt=1,Wt=2,Pi=0,hs=1,pl=2,ml=3,gl=4,Th=5;var Li=100,Rh=101,Ch=102,Ph=103,Lh=104,Ih=200,Nh=201,Dh=202,Uh=203,vl=204,xl=205,Oh=206,Fh=207,Bh=208,kh=209,zh=210,Gh=211,Vh=212,Hh=213,Wh=214,qr=0,Yr=1,$r=2,es=3,Zr=4,jr=5,Jr=6,Kr=7,yl=0,Xh=1,qh=2,Cn=0,Sl=1,Ml=2,bl=3,_l=4,wl=5,El=6,Al=7;var Tl=300,Ii=301,us=302,To=303,Ro=304,Qr=1e3,An=1001,eo=1002,Tt=1003,Yh=1004;var js=1005;var Vt=1006,Co=1007;var qn=1008;var sn=1009,Rl=1010,Cl=1011,ds=1012,Po=1013,yn=1014,Sn=1015,Mn=1016,Lo=1017,Io=1018,Ni=1020,Pl=35902,Ll=35899,Il=1021,Nl=1022,bn=1023,Vn=1026,Yn=1027,Dl=1028,No=1029,xi=1030,Do=1031;var Uo=1033,Js=33776,Ks=33777,Qs=33778,er=33779,Oo=35840,Fo=35841,Bo=35842,ko=35843,zo=36196,Go=37492,Vo=37496,Ho=37488,Wo=37489,tr=37490,Xo=37491,qo=37808,Yo=37809,$o=37810,Zo=37811,jo=37812,Jo=37813,Ko=37814,Qo=37815,ea=37816,ta=37817,na=37818,ia=37819,sa=37820,ra=37821,oa=36492,aa=36494,la=36495,ca=36283,ha=36284,nr=36285,ua=36286;var Ps=2300,to=2301,Wr=2302,ol=2303,al=2400,ll=2401,cl=2402;var $h=3200;var Ul=0,Zh=1,$n="",Kt="srgb",Ls="srgb-linear",Is="linear",Qe="srgb";var Xr=7680;var jh=519,Jh=512,Kh=513,Qh=514,Ol=515,eu=516,tu=517,Fl=518,Bl=519,nu=35044;var Di="300 es",hn=2e3,Ns=2001;function uf(i){for(let e=i.length-1;e>=0;--e)if(i[e]>=65535)return!0;return!1}function df(i){return ArrayBuffer.isView(i)&&!(i instanceof DataView)}function Ds(i){return document.createElementNS("http://www.w3.org/1999/xhtml",i)}function iu(){let i=Ds("canvas");return i.style.display="block",i}var jc={},ts=null;function kl(...i){let e="THREE."+i.shift();ts?ts("log",e,...i):console.log(e,...i)}function su(i){let e=i[0];if(typeof e=="string"&&e.startsWith("TSL:")){let t=i[1];t&&t.isStackTrace?i[0]+=" "+t.getLocation():i[1]='Stack trace not available. Enable "THREE.Node.captureStackTrace" to capture stack traces.'}return i}function Ce(...i){i=su(i);let e="THREE."+i.shift();if(ts)ts("warn",e,...i);else{let t=i[0];t&&t.isStackTrace?console.warn(t.getError(e)):console.warn(e,...i)}}function Ne(...i){i=su(i);let e="THREE."+i.shift();if(ts)ts("error",e,...i);else{let t=i[0];t&&t.isStackTrace?console.error(t.getError(e)):console.error(e,...i)}}function Ts(...i){let e=i.join(" ");e in jc||(jc[e]=!0,Ce(...i))}function ru(i,e,t){return new Promise(function(n,s){function r(){switch(i.clientWaitSync(e,i.SYNC_FLUSH_COMMANDS_BIT,0)){case i.WAIT_FAILED:s();break;case i.TIMEOUT_EXPIRED:setTimeout(r,t);break;default:n()}}setTimeout(r,t)})}var ou={[qr]:qr,[$r]:Jr,[Zr]:Zr,[es]:jr,[Yr]:Yr,[Jr]:$r,[Kr]:Kr,[jr]:es},xn=class{addEventListener(e,t){this.Ye===void 0&&(this.Ye={});let n=this.Ye;n[e]===void 0&&(n[e]=[]),n[e].indexOf(t)===-1&&n[e].push(t)}hasEventListener(e,t){let n=this.Ye;return n===void 0?!1:n[e]!==void 0&&n[e].indexOf(t)!==-1}removeEventListener(e,t){let n=this.Ye;if(n===void 0)return;let s=n[e];if(s!==void 0){let r=s.indexOf(t);r!==-1&&s.splice(r,1)}}dispatchEvent(e){let t=this.Ye;if(t===void 0)return;let n=t[e.type];if(n!==void 0){e.target=this;let s=n.slice(0);for(let r=0,o=s.length;r<o;r++)s[r].call(this,e);e.target=null}}},Ft=["00","01","02","03","04","05","06","07","08","09","0a","0b","0c","0d","0e","0f","10","11","12","13","14","15","16","17","18","19","1a","1b","1c","1d","1e","1f","20","21","22","23","24","25","26","27","28","29","2a","2b","2c","2d","2e","2f","30","31","32","33","34","35","36","37","38","39","3a","3b","3c","3d","3e","3f","40","41","42","43","44","45","46","47","48","49","4a","4b","4c","4d","4e","4f","50","51","52","53","54","55","56","57","58","59","5a","5b","5c","5d","5e","5f","60","61","62","63","64","65","66","67","68","69","6a","6b","6c","6d","6e","6f","70","71","72","73","74","75","76","77","78","79","7a","7b","7c","7d","7e","7f","80","81","82","83","84","85","86","87","88","89","8a","8b","8c","8d","8e","8f","90","91","92","93","94","95","96","97","98","99","9a","9b","9c","9d","9e","9f","a0","a1","a2","a3","a4","a5","a6","a7","a8","a9","aa","ab","ac","ad","ae","af","b0","b1","b2","b3","b4","b5","b6","b7","b8","b9","ba","bb","bc","bd","be","bf","c0","c1","c2","c3","c4","c5","c6","c7","c8","c9","ca","cb","cc","cd","ce","cf","d0","d1","d2","d3","d4","d5","d6","d7","d8","d9","da","db","dc","dd","de","df","e0","e1","e2","e3","e4","e5","e6","e7","e8","e9","ea","eb","ec","ed","ee","ef","f0","f1","f2","f3","f4","f5","f6","f7","f8","f9","fa","fb","fc","fd","fe","ff"],Jc=1234567,Rs=Math.PI/180,ns=180/Math.PI;function fs(){let i=Math.random()*4294967295|0,e=Math.random()*4294967295|0,t=Math.random()*4294967295|0,n=Math.random()*4294967295|0;return(Ft[i&255]+Ft[i>>8&255]+Ft[i>>16&255]+Ft[i>>24&255]+"-"+Ft[e&255]+Ft[e>>8&255]+"-"+Ft[e>>16&15|64]+Ft[e>>24&255]+"-"+Ft[t&63|128]+Ft[t>>8&255]+"-"+Ft[t>>16&255]+Ft[t>>24&255]+Ft[n&255]+Ft[n>>8&255]+Ft[n>>16&255]+Ft[n>>24&255]).toLowerCase()}function He(i,e,t){return Math.max(e,Math.min(t,i))}function zl(i,e){return(i%e+e)%e}function ff(i,e,t,n,s){return n+(i-e)*(s-n)/(t-e)}function pf(i,e,t){return i!==e?(t-i)/(e-i):0}function Cs(i,e,t){return(1-t)*i+t*e}function mf(i,e,t,n){return Cs(i,e,1-Math.exp(-t*n))}function gf(i,e=1){return e-Math.abs(zl(i,e*2)-e)}function vf(i,e,t){return i<=e?0:i>=t?1:(i=(i-e)/(t-e),i*i*(3-2*i))}function xf(i,e,t){return i<=e?0:i>=t?1:(i=(i-e)/(t-e),i*i*i*(i*(i*6-15)+10))}function yf(i,e){return i+Math.floor(Math.random()*(e-i+1))}function Sf(i,e){return i+Math.random()*(e-i)}function Mf(i){return i*(.5-Math.random())}function bf(i){i!==void 0&&(Jc=i);let e=Jc+=1831565813;return e=Math.imul(e^e>>>15,e|1),e^=e+Math.imul(e^e>>>7,e|61),((e^e>>>14)>>>0)/4294967296}function _f(i){return i*Rs}function wf(i){return i*ns}function Ef(i){return i>0&&Number.isInteger(i)&&2**Math.round(Math.log2(i))===i}function Af(i){return Math.pow(2,Math.ceil(Math.log(i)/Math.LN2))}function Gl(i){return Math.pow(2,Math.floor(Math.log(i)/Math.LN2))}function Tf(i,e,t,n,s){let r=Math.cos,o=Math.sin,a=r(t/2),l=o(t/2),c=r((e+n)/2),h=o((e+n)/2),d=r((e-n)/2),u=o((e-n)/2),f=r((n-e)/2),v=o((n-e)/2);switch(s){case"XYX":i.set(a*h,l*d,l*u,a*c);break;case"YZY":i.set(l*u,a*h,l*d,a*c);break;case"ZXZ":i.set(l*d,l*u,a*h,a*c);break;case"XZX":i.set(a*h,l*v,l*f,a*c);break;case"YXY":i.set(l*f,a*h,l*v,a*c);break;case"ZYZ":i.set(l*v,l*f,a*h,a*c);break;default:Ce("MathUtils: .setQuaternionFromProperEuler() encountered an unknown order: "+s)}}function Vl(i){switch(i.constructor){case Uint32Array:return 4294967295;case Uint16Array:return 65535;case Uint8Array:case Uint8ClampedArray:return 255;case Int32Array:return 2147483647;case Int16Array:return 32767;case Int8Array:return 127;default:return}}function au(i,e){if(e.constructor===Float32Array)return i;let t=Vl(e);if(t===void 0)throw new Error("THREE.MathUtils: Invalid component type.");return Math.max(i/t,-1)}function lu(i,e){if(e.constructor===Float32Array)return i;let t=Vl(e);if(t===void 0)throw new Error("THREE.MathUtils: Invalid component type.");return Math.round(i*t)}var Hl={DEG2RAD:Rs,RAD2DEG:ns,generateUUID:fs,clamp:He,euclideanModulo:zl,mapLinear:ff,inverseLerp:pf,lerp:Cs,damp:mf,pingpong:gf,smoothstep:vf,smootherstep:xf,randInt:yf,randFloat:Sf,randFloatSpread:Mf,seededRandom:bf,degToRad:_f,radToDeg:wf,isPowerOfTwo:Ef,ceilPowerOfTwo:Af,floorPowerOfTwo:Gl,setQuaternionFromProperEuler:Tf,normalize:lu,denormalize:au},De=class{static{this.prototype.isVector2=!0}constructor(e=0,t=0){this.x=e,this.y=t}get width(){return this.x}set width(e){this.x=e}get height(){return this.y}set height(e){this.y=e}set(e,t){return this.x=e,this.y=t,this}setScalar(e){return this.x=e,this.y=e,this}setX(e){return this.x=e,this}setY(e){return this.y=e,this}setComponent(e,t){switch(e){case 0:this.x=t;break;case 1:this.y=t;break;default:throw new Error("THREE.Vector2: index is out of range: "+e)}return this}getComponent(e){switch(e){case 0:return this.x;case 1:return this.y;default:throw new Error("THREE.Vector2: index is out of range: "+e)}}clone(){return new this.constructor(this.x,this.y)}copy(e){return this.x=e.x,this.y=e.y,this}add(e){return this.x+=e.x,this.y+=e.y,this}addScalar(e){return this.x+=e,this.y+=e,this}addVectors(e,t){return this.x=e.x+t.x,this.y=e.y+t.y,this}addScaledVector(e,t){return this.x+=e.x*t,this.y+=e.y*t,this}sub(e){return this.x-=e.x,this.y-=e.y,this}subScalar(e){return this.x-=e,this.y-=e,this}subVectors(e,t){return this.x=e.x-t.x,this.y=e.y-t.y,this}multiply(e){return this.x*=e.x,this.y*=e.y,this}multiplyScalar(e){return this.x*=e,this.y*=e,this}divide(e){return this.x/=e.x,this.y/=e.y,this}divideScalar(e){return this.multiplyScalar(1/e)}applyMatrix3(e){let t=this.x,n=this.y,s=e.elements;return this.x=s[0]*t+s[3]*n+s[6],this.y=s[1]*t+s[4]*n+s[7],this}min(e){return this.x=Math.min(this.x,e.x),this.y=Math.min(this.y,e.y),this}max(e){return this.x=Math.max(this.x,e.x),this.y=Math.max(this.y,e.y),this}clamp(e,t){return this.x=He(this.x,e.x,t.x),this.y=He(this.y,e.y,t.y),this}clampScalar(e,t){return this.x=He(this.x,e,t),this.y=He(this.y,e,t),this}clampLength(e,t){let n=this.length();return this.divideScalar(n||1).multiplyScalar(He(n,e,t))}floor(){return this.x=Math.floor(this.x),this.y=Math.floor(this.y),this}ceil(){return this.x=Math.ceil(this.x),this.y=Math.ceil(this.y),this}round(){return this.x=Math.round(this.x),this.y=Math.round(this.y),this}roundToZero(){return this.x=Math.trunc(this.x),this.y=Math.trunc(this.y),this}negate(){return this.x=-this.x,this.y=-this.y,this}dot(e){return this.x*e.x+this.y*e.y}cross(e){return this.x*e.y-this.y*e.x}lengthSq(){return this.x*this.x+this.y*this.y}length(){return Math.sqrt(this.x*this.x+this.y*this.y)}manhattanLength(){return Math.abs(this.x)+Math.abs(this.y)}normalize(){return this.divideScalar(this.length()||1)}angle(){return Math.atan2(-this.y,-this.x)+Math.PI}angleTo(e){let t=Math.sqrt(this.lengthSq()*e.lengthSq());if(t===0)return Math.PI/2;let n=this.dot(e)/t;return Math.acos(He(n,-1,1))}distanceTo(e){return Math.sqrt(this.distanceToSquared(e))}distanceToSquared(e){let t=this.x-e.x,n=this.y-e.y;return t*t+n*n}manhattanDistanceTo(e){return Math.abs(this.x-e.x)+Math.abs(this.y-e.y)}setLength(e){return this.normalize().multiplyScalar(e)}lerp(e,t){return this.x+=(e.x-this.x)*t,this.y+=(e.y-this.y)*t,this}lerpVectors(e,t,n){return this.x=e.x+(t.x-e.x)*n,this.y=e.y+(t.y-e.y)*n,this}equals(e){return e.x===this.x&&e.y===this.y}fromArray(e,t=0){return this.x=e[t],this.y=e[t+1],this}toArray(e=[],t=0){return e[t]=this.x,e[t+1]=this.y,e}fromBufferAttribute(e,t){return this.x=e.getX(t),this.y=e.getY(t),this}rotateAround(e,t){let n=Math.cos(t),s=Math.sin(t),r=this.x-e.x,o=this.y-e.y;return this.x=r*n-o*s+e.x,this.y=r*s+o*n+e.y,this}random(){return this.x=Math.random(),this.y=Math.random(),this}*[Symbol.iterator](){yield this.x,yield this.y}},en=class{constructor(e=0,t=0,n=0,s=1){this.isQuaternion=!0,this.e=e,this.o=t,this.v=n,this.S=s}static slerpFlat(e,t,n,s,r,o,a){let l=n[s+0],c=n[s+1],h=n[s+2],d=n[s+3],u=r[o+0],f=r[o+1],v=r[o+2],S=r[o+3];if(d!==S||l!==u||c!==f||h!==v){let m=l*u+c*f+h*v+d*S;m<0&&(u=-u,f=-f,v=-v,S=-S,m=-m);let p=1-a;if(m<.9995){let _=Math.acos(m),R=Math.sin(_);p=Math.sin(p*_)/R,a=Math.sin(a*_)/R,l=l*p+u*a,c=c*p+f*a,h=h*p+v*a,d=d*p+S*a}else{l=l*p+u*a,c=c*p+f*a,h=h*p+v*a,d=d*p+S*a;let _=1/Math.sqrt(l*l+c*c+h*h+d*d);l*=_,c*=_,h*=_,d*=_}}e[t]=l,e[t+1]=c,e[t+2]=h,e[t+3]=d}static multiplyQuaternionsFlat(e,t,n,s,r,o){let a=n[s],l=n[s+1],c=n[s+2],h=n[s+3],d=r[o],u=r[o+1],f=r[o+2],v=r[o+3];return e[t]=a*v+h*d+l*f-c*u,e[t+1]=l*v+h*u+c*d-a*f,e[t+2]=c*v+h*f+a*u-l*d,e[t+3]=h*v-a*d-l*u-c*f,e}get x(){return this.e}set x(e){this.e=e,this.A()}get y(){return this.o}set y(e){this.o=e,this.A()}get z(){return this.v}set z(e){this.v=e,this.A()}get w(){return this.S}set w(e){this.S=e,this.A()}set(e,t,n,s){return this.e=e,this.o=t,this.v=n,this.S=s,this.A(),this}clone(){return new this.constructor(this.e,this.o,this.v,this.S)}copy(e){return this.e=e.x,this.o=e.y,this.v=e.z,this.S=e.w,this.A(),this}setFromEuler(e,t=!0){let n=e.e,s=e.o,r=e.v,o=e.U,a=Math.cos,l=Math.sin,c=a(n/2),h=a(s/2),d=a(r/2),u=l(n/2),f=l(s/2),v=l(r/2);switch(o){case"XYZ":this.e=u*h*d+c*f*v,this.o=c*f*d-u*h*v,this.v=c*h*v+u*f*d,this.S=c*h*d-u*f*v;break;case"YXZ":this.e=u*h*d+c*f*v,this.o=c*f*d-u*h*v,this.v=c*h*v-u*f*d,this.S=c*h*d+u*f*v;break;case"ZXY":this.e=u*h*d-c*f*v,this.o=c*f*d+u*h*v,this.v=c*h*v+u*f*d,this.S=c*h*d-u*f*v;break;case"ZYX":this.e=u*h*d-c*f*v,this.o=c*f*d+u*h*v,this.v=c*h*v-u*f*d,this.S=c*h*d+u*f*v;break;case"YZX":this.e=u*h*d+c*f*v,this.o=c*f*d+u*h*v,this.v=c*h*v-u*f*d,this.S=c*h*d-u*f*v;break;case"XZY":this.e=u*h*d-c*f*v,this.o=c*f*d-u*h*v,this.v=c*h*v+u*f*d,this.S=c*h*d+u*f*v;break;default:Ce("Quaternion: .setFromEuler() encountered an unknown order: "+o)}return t===!0&&this.A(),this}setFromAxisAngle(e,t){let n=t/2,s=Math.sin(n);return this.e=e.x*s,this.o=e.y*s,this.v=e.z*s,this.S=Math.cos(n),this.A(),this}setFromRotationMatrix(e){let t=e.elements,n=t[0],s=t[4],r=t[8],o=t[1],a=t[5],l=t[9],c=t[2],h=t[6],d=t[10],u=n+a+d;if(u>0){let f=.5/Math.sqrt(u+1);this.S=.25/f,this.e=(h-l)*f,this.o=(r-c)*f,this.v=(o-s)*f}else if(n>a&&n>d){let f=2*Math.sqrt(1+n-a-d);this.S=(h-l)/f,this.e=.25*f,this.o=(s+o)/f,this.v=(r+c)/f}else if(a>d){let f=2*Math.sqrt(1+a-n-d);this.S=(r-c)/f,this.e=(s+o)/f,this.o=.25*f,this.v=(l+h)/f}else{let f=2*Math.sqrt(1+d-n-a);this.S=(o-s)/f,this.e=(r+c)/f,this.o=(l+h)/f,this.v=.25*f}return this.A(),this}setFromUnitVectors(e,t){let n=e.dot(t)+1;return n<1e-8?(n=0,Math.abs(e.x)>Math.abs(e.z)?(this.e=-e.y,this.o=e.x,this.v=0,this.S=n):(this.e=0,this.o=-e.z,this.v=e.y,this.S=n)):(this.e=e.y*t.z-e.z*t.y,this.o=e.z*t.x-e.x*t.z,this.v=e.x*t.y-e.y*t.x,this.S=n),this.normalize()}angleTo(e){return 2*Math.acos(Math.abs(He(this.dot(e),-1,1)))}rotateTowards(e,t){let n=this.angleTo(e);if(n===0)return this;let s=Math.min(1,t/n);return this.slerp(e,s),this}identity(){return this.set(0,0,0,1)}invert(){return this.conjugate()}conjugate(){return this.e*=-1,this.o*=-1,this.v*=-1,this.A(),this}dot(e){return this.e*e.e+this.o*e.o+this.v*e.v+this.S*e.S}lengthSq(){return this.e*this.e+this.o*this.o+this.v*this.v+this.S*this.S}length(){return Math.sqrt(this.e*this.e+this.o*this.o+this.v*this.v+this.S*this.S)}normalize(){let e=this.length();return e===0?(this.e=0,this.o=0,this.v=0,this.S=1):(e=1/e,this.e=this.e*e,this.o=this.o*e,this.v=this.v*e,this.S=this.S*e),this.A(),this}multiply(e){return this.multiplyQuaternions(this,e)}premultiply(e){return this.multiplyQuaternions(e,this)}multiplyQuaternions(e,t){let n=e.e,s=e.o,r=e.v,o=e.S,a=t.e,l=t.o,c=t.v,h=t.S;return this.e=n*h+o*a+s*c-r*l,this.o=s*h+o*l+r*a-n*c,this.v=r*h+o*c+n*l-s*a,this.S=o*h-n*a-s*l-r*c,this.A(),this}slerp(e,t){let n=e.e,s=e.o,r=e.v,o=e.S,a=this.dot(e);a<0&&(n=-n,s=-s,r=-r,o=-o,a=-a);let l=1-t;if(a<.9995){let c=Math.acos(a),h=Math.sin(c);l=Math.sin(l*c)/h,t=Math.sin(t*c)/h,this.e=this.e*l+n*t,this.o=this.o*l+s*t,this.v=this.v*l+r*t,this.S=this.S*l+o*t,this.A()}else this.e=this.e*l+n*t,this.o=this.o*l+s*t,this.v=this.v*l+r*t,this.S=this.S*l+o*t,this.normalize();return this}slerpQuaternions(e,t,n){return this.copy(e).slerp(t,n)}random(){let e=2*Math.PI*Math.random(),t=2*Math.PI*Math.random(),n=Math.random(),s=Math.sqrt(1-n),r=Math.sqrt(n);return this.set(s*Math.sin(e),s*Math.cos(e),r*Math.sin(t),r*Math.cos(t))}equals(e){return e.e===this.e&&e.o===this.o&&e.v===this.v&&e.S===this.S}fromArray(e,t=0){return this.e=e[t],this.o=e[t+1],this.v=e[t+2],this.S=e[t+3],this.A(),this}toArray(e=[],t=0){return e[t]=this.e,e[t+1]=this.o,e[t+2]=this.v,e[t+3]=this.S,e}fromBufferAttribute(e,t){return this.e=e.getX(t),this.o=e.getY(t),this.v=e.getZ(t),this.S=e.getW(t),this.A(),this}toJSON(){return this.toArray()}Ut(e){return this.A=e,this}A(){}*[Symbol.iterator](){yield this.e,yield this.o,yield this.v,yield this.S}},N=class{static{this.prototype.isVector3=!0}constructor(e=0,t=0,n=0){this.x=e,this.y=t,this.z=n}set(e,t,n){return n===void 0&&(n=this.z),this.x=e,this.y=t,this.z=n,this}setScalar(e){return this.x=e,this.y=e,this.z=e,this}setX(e){return this.x=e,this}setY(e){return this.y=e,this}setZ(e){return this.z=e,this}setComponent(e,t){switch(e){case 0:this.x=t;break;case 1:this.y=t;break;case 2:this.z=t;break;default:throw new Error("THREE.Vector3: index is out of range: "+e)}return this}getComponent(e){switch(e){case 0:return this.x;case 1:return this.y;case 2:return this.z;default:throw new Error("THREE.Vector3: index is out of range: "+e)}}clone(){return new this.constructor(this.x,this.y,this.z)}copy(e){return this.x=e.x,this.y=e.y,this.z=e.z,this}add(e){return this.x+=e.x,this.y+=e.y,this.z+=e.z,this}addScalar(e){return this.x+=e,this.y+=e,this.z+=e,this}addVectors(e,t){return this.x=e.x+t.x,this.y=e.y+t.y,this.z=e.z+t.z,this}addScaledVector(e,t){return this.x+=e.x*t,this.y+=e.y*t,this.z+=e.z*t,this}sub(e){return this.x-=e.x,this.y-=e.y,this.z-=e.z,this}subScalar(e){return this.x-=e,this.y-=e,this.z-=e,this}subVectors(e,t){return this.x=e.x-t.x,this.y=e.y-t.y,this.z=e.z-t.z,this}multiply(e){return this.x*=e.x,this.y*=e.y,this.z*=e.z,this}multiplyScalar(e){return this.x*=e,this.y*=e,this.z*=e,this}multiplyVectors(e,t){return this.x=e.x*t.x,this.y=e.y*t.y,this.z=e.z*t.z,this}applyEuler(e){return this.applyQuaternion(Kc.setFromEuler(e))}applyAxisAngle(e,t){return this.applyQuaternion(Kc.setFromAxisAngle(e,t))}applyMatrix3(e){let t=this.x,n=this.y,s=this.z,r=e.elements;return this.x=r[0]*t+r[3]*n+r[6]*s,this.y=r[1]*t+r[4]*n+r[7]*s,this.z=r[2]*t+r[5]*n+r[8]*s,this}applyNormalMatrix(e){return this.applyMatrix3(e).normalize()}applyMatrix4(e){let t=this.x,n=this.y,s=this.z,r=e.elements,o=1/(r[3]*t+r[7]*n+r[11]*s+r[15]);return this.x=(r[0]*t+r[4]*n+r[8]*s+r[12])*o,this.y=(r[1]*t+r[5]*n+r[9]*s+r[13])*o,this.z=(r[2]*t+r[6]*n+r[10]*s+r[14])*o,this}applyQuaternion(e){let t=this.x,n=this.y,s=this.z,r=e.x,o=e.y,a=e.z,l=e.w,c=2*(o*s-a*n),h=2*(a*t-r*s),d=2*(r*n-o*t);return this.x=t+l*c+o*d-a*h,this.y=n+l*h+a*c-r*d,this.z=s+l*d+r*h-o*c,this}project(e){return this.applyMatrix4(e.matrixWorldInverse).applyMatrix4(e.projectionMatrix)}unproject(e){return this.applyMatrix4(e.projectionMatrixInverse).applyMatrix4(e.matrixWorld)}transformDirection(e){let t=this.x,n=this.y,s=this.z,r=e.elements;return this.x=r[0]*t+r[4]*n+r[8]*s,this.y=r[1]*t+r[5]*n+r[9]*s,this.z=r[2]*t+r[6]*n+r[10]*s,this.normalize()}divide(e){return this.x/=e.x,this.y/=e.y,this.z/=e.z,this}divideScalar(e){return this.multiplyScalar(1/e)}min(e){return this.x=Math.min(this.x,e.x),this.y=Math.min(this.y,e.y),this.z=Math.min(this.z,e.z),this}max(e){return this.x=Math.max(this.x,e.x),this.y=Math.max(this.y,e.y),this.z=Math.max(this.z,e.z),this}clamp(e,t){return this.x=He(this.x,e.x,t.x),this.y=He(this.y,e.y,t.y),this.z=He(this.z,e.z,t.z),this}clampScalar(e,t){return this.x=He(this.x,e,t),this.y=He(this.y,e,t),this.z=He(this.z,e,t),this}clampLength(e,t){let n=this.length();return this.divideScalar(n||1).multiplyScalar(He(n,e,t))}floor(){return this.x=Math.floor(this.x),this.y=Math.floor(this.y),this.z=Math.floor(this.z),this}ceil(){return this.x=Math.ceil(this.x),this.y=Math.ceil(this.y),this.z=Math.ceil(this.z),this}round(){return this.x=Math.round(this.x),this.y=Math.round(this.y),this.z=Math.round(this.z),this}roundToZero(){return this.x=Math.trunc(this.x),this.y=Math.trunc(this.y),this.z=Math.trunc(this.z),this}negate(){return this.x=-this.x,this.y=-this.y,this.z=-this.z,this}dot(e){return this.x*e.x+this.y*e.y+this.z*e.z}lengthSq(){return this.x*this.x+this.y*this.y+this.z*this.z}length(){return Math.sqrt(this.x*this.x+this.y*this.y+this.z*this.z)}manhattanLength(){return Math.abs(this.x)+Math.abs(this.y)+Math.abs(this.z)}normalize(){return this.divideScalar(this.length()||1)}setLength(e){return this.normalize().multiplyScalar(e)}lerp(e,t){return this.x+=(e.x-this.x)*t,this.y+=(e.y-this.y)*t,this.z+=(e.z-this.z)*t,this}lerpVectors(e,t,n){return this.x=e.x+(t.x-e.x)*n,this.y=e.y+(t.y-e.y)*n,this.z=e.z+(t.z-e.z)*n,this}cross(e){return this.crossVectors(this,e)}crossVectors(e,t){let n=e.x,s=e.y,r=e.z,o=t.x,a=t.y,l=t.z;return this.x=s*l-r*a,this.y=r*o-n*l,this.z=n*a-s*o,this}projectOnVector(e){let t=e.lengthSq();if(t===0)return this.set(0,0,0);let n=e.dot(this)/t;return this.copy(e).multiplyScalar(n)}projectOnPlane(e){return za.copy(this).projectOnVector(e),this.sub(za)}reflect(e){return this.sub(za.copy(e).multiplyScalar(2*this.dot(e)))}angleTo(e){let t=Math.sqrt(this.lengthSq()*e.lengthSq());if(t===0)return Math.PI/2;let n=this.dot(e)/t;return Math.acos(He(n,-1,1))}distanceTo(e){return Math.sqrt(this.distanceToSquared(e))}distanceToSquared(e){let t=this.x-e.x,n=this.y-e.y,s=this.z-e.z;return t*t+n*n+s*s}manhattanDistanceTo(e){return Math.abs(this.x-e.x)+Math.abs(this.y-e.y)+Math.abs(this.z-e.z)}setFromSpherical(e){return this.setFromSphericalCoords(e.radius,e.phi,e.theta)}setFromSphericalCoords(e,t,n){let s=Math.sin(t)*e;return this.x=s*Math.sin(n),this.y=Math.cos(t)*e,this.z=s*Math.cos(n),this}setFromCylindrical(e){return this.setFromCylindricalCoords(e.radius,e.theta,e.y)}setFromCylindricalCoords(e,t,n){return this.x=e*Math.sin(t),this.y=n,this.z=e*Math.cos(t),this}setFromMatrixPosition(e){let t=e.elements;return this.x=t[12],this.y=t[13],this.z=t[14],this}setFromMatrixScale(e){let t=this.setFromMatrixColumn(e,0).length(),n=this.setFromMatrixColumn(e,1).length(),s=this.setFromMatrixColumn(e,2).length();return this.x=t,this.y=n,this.z=s,this}setFromMatrixColumn(e,t){return this.fromArray(e.elements,t*4)}setFromMatrix3Column(e,t){return this.fromArray(e.elements,t*3)}setFromEuler(e){return this.x=e.e,this.y=e.o,this.z=e.v,this}setFromColor(e){return this.x=e.r,this.y=e.g,this.z=e.b,this}equals(e){return e.x===this.x&&e.y===this.y&&e.z===this.z}fromArray(e,t=0){return this.x=e[t],this.y=e[t+1],this.z=e[t+2],this}toArray(e=[],t=0){return e[t]=this.x,e[t+1]=this.y,e[t+2]=this.z,e}fromBufferAttribute(e,t){return this.x=e.getX(t),this.y=e.getY(t),this.z=e.getZ(t),this}random(){return this.x=Math.random(),this.y=Math.random(),this.z=Math.random(),this}randomDirection(){let e=Math.random()*Math.PI*2,t=Math.random()*2-1,n=Math.sqrt(1-t*t);return this.x=n*Math.cos(e),this.y=t,this.z=n*Math.sin(e),this}*[Symbol.iterator](){yield this.x,yield this.y,yield this.z}},za=new N,Kc=new en,Ue=class{static{this.prototype.isMatrix3=!0}constructor(e,t,n,s,r,o,a,l,c){this.elements=[1,0,0,0,1,0,0,0,1],e!==void 0&&this.set(e,t,n,s,r,o,a,l,c)}set(e,t,n,s,r,o,a,l,c){let h=this.elements;return h[0]=e,h[1]=s,h[2]=a,h[3]=t,h[4]=r,h[5]=l,h[6]=n,h[7]=o,h[8]=c,this}identity(){return this.set(1,0,0,0,1,0,0,0,1),this}copy(e){let t=this.elements,n=e.elements;return t[0]=n[0],t[1]=n[1],t[2]=n[2],t[3]=n[3],t[4]=n[4],t[5]=n[5],t[6]=n[6],t[7]=n[7],t[8]=n[8],this}extractBasis(e,t,n){return e.setFromMatrix3Column(this,0),t.setFromMatrix3Column(this,1),n.setFromMatrix3Column(this,2),this}setFromMatrix4(e){let t=e.elements;return this.set(t[0],t[4],t[8],t[1],t[5],t[9],t[2],t[6],t[10]),this}multiply(e){return this.multiplyMatrices(this,e)}premultiply(e){return this.multiplyMatrices(e,this)}multiplyMatrices(e,t){let n=e.elements,s=t.elements,r=this.elements,o=n[0],a=n[3],l=n[6],c=n[1],h=n[4],d=n[7],u=n[2],f=n[5],v=n[8],S=s[0],m=s[3],p=s[6],_=s[1],R=s[4],w=s[7],T=s[2],E=s[5],g=s[8];return r[0]=o*S+a*_+l*T,r[3]=o*m+a*R+l*E,r[6]=o*p+a*w+l*g,r[1]=c*S+h*_+d*T,r[4]=c*m+h*R+d*E,r[7]=c*p+h*w+d*g,r[2]=u*S+f*_+v*T,r[5]=u*m+f*R+v*E,r[8]=u*p+f*w+v*g,this}multiplyScalar(e){let t=this.elements;return t[0]*=e,t[3]*=e,t[6]*=e,t[1]*=e,t[4]*=e,t[7]*=e,t[2]*=e,t[5]*=e,t[8]*=e,this}determinant(){let e=this.elements,t=e[0],n=e[1],s=e[2],r=e[3],o=e[4],a=e[5],l=e[6],c=e[7],h=e[8];return t*o*h-t*a*c-n*r*h+n*a*l+s*r*c-s*o*l}invert(){let e=this.elements,t=e[0],n=e[1],s=e[2],r=e[3],o=e[4],a=e[5],l=e[6],c=e[7],h=e[8],d=h*o-a*c,u=a*l-h*r,f=c*r-o*l,v=t*d+n*u+s*f;if(v===0)return this.set(0,0,0,0,0,0,0,0,0);let S=1/v;return e[0]=d*S,e[1]=(s*c-h*n)*S,e[2]=(a*n-s*o)*S,e[3]=u*S,e[4]=(h*t-s*l)*S,e[5]=(s*r-a*t)*S,e[6]=f*S,e[7]=(n*l-c*t)*S,e[8]=(o*t-n*r)*S,this}transpose(){let e,t=this.elements;return e=t[1],t[1]=t[3],t[3]=e,e=t[2],t[2]=t[6],t[6]=e,e=t[5],t[5]=t[7],t[7]=e,this}getNormalMatrix(e){return this.setFromMatrix4(e).invert().transpose()}transposeIntoArray(e){let t=this.elements;return e[0]=t[0],e[1]=t[3],e[2]=t[6],e[3]=t[1],e[4]=t[4],e[5]=t[7],e[6]=t[2],e[7]=t[5],e[8]=t[8],this}setUvTransform(e,t,n,s,r,o,a){let l=Math.cos(r),c=Math.sin(r);return this.set(n*l,n*c,-n*(l*o+c*a)+o+e,-s*c,s*l,-s*(-c*o+l*a)+a+t,0,0,1),this}scale(e,t){return Ts("Matrix3: .scale() is deprecated. Use .makeScale() instead."),this.premultiply(Ga.makeScale(e,t)),this}rotate(e){return Ts("Matrix3: .rotate() is deprecated. Use .makeRotation() instead."),this.premultiply(Ga.makeRotation(-e)),this}translate(e,t){return Ts("Matrix3: .translate() is deprecated. Use .makeTranslation() instead."),this.premultiply(Ga.makeTranslation(e,t)),this}makeTranslation(e,t){return e.isVector2?this.set(1,0,e.x,0,1,e.y,0,0,1):this.set(1,0,e,0,1,t,0,0,1),this}makeRotation(e){let t=Math.cos(e),n=Math.sin(e);return this.set(t,-n,0,n,t,0,0,0,1),this}makeScale(e,t){return this.set(e,0,0,0,t,0,0,0,1),this}equals(e){let t=this.elements,n=e.elements;for(let s=0;s<9;s++)if(t[s]!==n[s])return!1;return!0}fromArray(e,t=0){for(let n=0;n<9;n++)this.elements[n]=e[n+t];return this}toArray(e=[],t=0){let n=this.elements;return e[t]=n[0],e[t+1]=n[1],e[t+2]=n[2],e[t+3]=n[3],e[t+4]=n[4],e[t+5]=n[5],e[t+6]=n[6],e[t+7]=n[7],e[t+8]=n[8],e}clone(){return new this.constructor().fromArray(this.elements)}},Ga=new Ue,Qc=new Ue().set(.4123908,.3575843,.1804808,.212639,.7151687,.0721923,.0193308,.1191948,.9505322),eh=new Ue().set(3.2409699,-1.5373832,-.4986108,-.9692436,1.8759675,.0415551,.0556301,-.203977,1.0569715);function Rf(){let i={enabled:!0,workingColorSpace:Ls,spaces:{},convert:function(s,r,o){return this.enabled===!1||r===o||!r||!o||(this.spaces[r].transfer===Qe&&(s.r=Gn(s.r),s.g=Gn(s.g),s.b=Gn(s.b)),this.spaces[r].primaries!==this.spaces[o].primaries&&(s.applyMatrix3(this.spaces[r].toXYZ),s.applyMatrix3(this.spaces[o].fromXYZ)),this.spaces[o].transfer===Qe&&(s.r=Qi(s.r),s.g=Qi(s.g),s.b=Qi(s.b))),s},workingToColorSpace:function(s,r){return this.convert(s,this.workingColorSpace,r)},colorSpaceToWorking:function(s,r){return this.convert(s,r,this.workingColorSpace)},getPrimaries:function(s){return this.spaces[s].primaries},getTransfer:function(s){return s===$n?Is:this.spaces[s].transfer},getToneMappingMode:function(s){return this.spaces[s].outputColorSpaceConfig.toneMappingMode||"standard"},getLuminanceCoefficients:function(s,r=this.workingColorSpace){return s.fromArray(this.spaces[r].luminanceCoefficients)},define:function(s){Object.assign(this.spaces,s)},Oi:function(s,r,o){return s.copy(this.spaces[o].fromXYZ).multiply(this.spaces[r].toXYZ)},Fi:function(s){return this.spaces[s].outputColorSpaceConfig.drawingBufferColorSpace},Bi:function(s=this.workingColorSpace){return this.spaces[s].workingColorSpaceConfig.unpackColorSpace}},e=[.64,.33,.3,.6,.15,.06],t=[.2126,.7152,.0722],n=[.3127,.329];return i.define({[Ls]:{primaries:e,whitePoint:n,transfer:Is,toXYZ:Qc,fromXYZ:eh,luminanceCoefficients:t,workingColorSpaceConfig:{unpackColorSpace:Kt},outputColorSpaceConfig:{drawingBufferColorSpace:Kt}},[Kt]:{primaries:e,whitePoint:n,transfer:Qe,toXYZ:Qc,fromXYZ:eh,luminanceCoefficients:t,outputColorSpaceConfig:{drawingBufferColorSpace:Kt}}}),i}var Ye=Rf();function Gn(i){return i<.04045?i*.0773993808:Math.pow(i*.9478672986+.0521327014,2.4)}function Qi(i){return i<.0031308?i*12.92:1.055*Math.pow(i,.41666)-.055}var zi,no=class{static getDataURL(e,t="image/png"){if(/^data:/i.test(e.src)||typeof HTMLCanvasElement>"u")return e.src;let n;if(e instanceof HTMLCanvasElement)n=e;else{zi===void 0&&(zi=Ds("canvas")),zi.width=e.width,zi.height=e.height;let s=zi.getContext("2d");e instanceof ImageData?s.putImageData(e,0,0):s.drawImage(e,0,0,e.width,e.height),n=zi}return n.toDataURL(t)}static sRGBToLinear(e){if(typeof HTMLImageElement<"u"&&e instanceof HTMLImageElement||typeof HTMLCanvasElement<"u"&&e instanceof HTMLCanvasElement||typeof ImageBitmap<"u"&&e instanceof ImageBitmap){let t=Ds("canvas");t.width=e.width,t.height=e.height;let n=t.getContext("2d");n.drawImage(e,0,0,e.width,e.height);let s=n.getImageData(0,0,e.width,e.height),r=s.data;for(let o=0;o<r.length;o++)r[o]=Gn(r[o]/255)*255;return n.putImageData(s,0,0),t}else if(e.data){let t=e.data.slice(0);for(let n=0;n<t.length;n++)t instanceof Uint8Array||t instanceof Uint8ClampedArray?t[n]=Math.floor(Gn(t[n]/255)*255):t[n]=Gn(t[n]);return{data:t,width:e.width,height:e.height}}else return Ce("ImageUtils.sRGBToLinear(): Unsupported image type. No color space conversion applied."),e}},Cf=0,is=class{constructor(e=null){this.isTextureSource=!0,Object.defineProperty(this,"id",{value:Cf++}),this.uuid=fs(),this.data=e,this.dataReady=!0,this.version=0}getSize(e){let t=this.data;return typeof HTMLVideoElement<"u"&&t instanceof HTMLVideoElement?e.set(t.videoWidth,t.videoHeight,0):typeof VideoFrame<"u"&&t instanceof VideoFrame?e.set(t.displayWidth,t.displayHeight,0):t!==null?e.set(t.width||0,t.height||0,t.depth||0):e.set(0,0,0),e}set needsUpdate(e){e===!0&&this.version++}toJSON(e){let t=e===void 0||typeof e=="string";if(!t&&e.images[this.uuid]!==void 0)return e.images[this.uuid];let n={uuid:this.uuid,url:""},s=this.data;if(s!==null){let r;if(Array.isArray(s)){r=[];for(let o=0,a=s.length;o<a;o++)s[o].isDataTexture?r.push(Va(s[o].image)):r.push(Va(s[o]))}else r=Va(s);n.url=r}return t||(e.images[this.uuid]=n),n}};function Va(i){return typeof HTMLImageElement<"u"&&i instanceof HTMLImageElement||typeof HTMLCanvasElement<"u"&&i instanceof HTMLCanvasElement||typeof ImageBitmap<"u"&&i instanceof ImageBitmap?no.getDataURL(i):i.data?{data:Array.from(i.data),width:i.width,height:i.height,type:i.data.constructor.name}:(Ce("Texture: Unable to serialize Texture."),{})}var Pf=0,Ha=new N,Yt=class i extends xn{constructor(e=i.DEFAULT_IMAGE,t=i.DEFAULT_MAPPING,n=An,s=An,r=Vt,o=qn,a=bn,l=sn,c=i.DEFAULT_ANISOTROPY,h=$n){super(),this.isTexture=!0,Object.defineProperty(this,"id",{value:Pf++}),this.uuid=fs(),this.name="",this.source=new is(e),this.mipmaps=[],this.mapping=t,this.channel=0,this.wrapS=n,this.wrapT=s,this.magFilter=r,this.minFilter=o,this.anisotropy=c,this.format=a,this.internalFormat=null,this.type=l,this.offset=new De(0,0),this.repeat=new De(1,1),this.center=new De(0,0),this.rotation=0,this.matrixAutoUpdate=!0,this.matrix=new Ue,this.generateMipmaps=!0,this.mipmapsAutoUpdate=!0,this.premultiplyAlpha=!1,this.flipY=!0,this.unpackAlignment=4,this.colorSpace=h,this.userData={},this.updateRanges=[],this.version=0,this.onUpdate=null,this.renderTarget=null,this.isRenderTargetTexture=!1,this.isArrayTexture=!!(e&&e.depth&&e.depth>1),this.pmremVersion=0,this.isPMREMTexture=!1,this.normalized=!1}get width(){return this.source.getSize(Ha).x}get height(){return this.source.getSize(Ha).y}get depth(){return this.source.getSize(Ha).z}get image(){return this.source.data}set image(e){this.source.data=e}updateMatrix(){this.matrix.setUvTransform(this.offset.x,this.offset.y,this.repeat.x,this.repeat.y,this.rotation,this.center.x,this.center.y)}addUpdateRange(e,t){this.updateRanges.push({start:e,count:t})}clearUpdateRanges(){this.updateRanges.length=0}clone(){return new this.constructor().copy(this)}copy(e){return this.name=e.name,this.source=e.source,this.mipmaps=e.mipmaps.slice(0),this.mapping=e.mapping,this.channel=e.channel,this.wrapS=e.wrapS,this.wrapT=e.wrapT,this.magFilter=e.magFilter,this.minFilter=e.minFilter,this.anisotropy=e.anisotropy,this.format=e.format,this.internalFormat=e.internalFormat,this.type=e.type,this.normalized=e.normalized,this.offset.copy(e.offset),this.repeat.copy(e.repeat),this.center.copy(e.center),this.rotation=e.rotation,this.matrixAutoUpdate=e.matrixAutoUpdate,this.matrix.copy(e.matrix),this.generateMipmaps=e.generateMipmaps,this.mipmapsAutoUpdate=e.mipmapsAutoUpdate,this.premultiplyAlpha=e.premultiplyAlpha,this.flipY=e.flipY,this.unpackAlignment=e.unpackAlignment,this.colorSpace=e.colorSpace,this.renderTarget=e.renderTarget,this.isRenderTargetTexture=e.isRenderTargetTexture,this.isPMREMTexture=e.isPMREMTexture,this.isArrayTexture=e.isArrayTexture,this.userData=JSON.parse(JSON.stringify(e.userData)),this.needsUpdate=!0,this}setValues(e){for(let t in e){let n=e[t];if(n===void 0){Ce(`Texture.setValues(): parameter '${t}' has value of undefined.`);continue}let s=this[t];if(s===void 0){Ce(`Texture.setValues(): property '${t}' does not exist.`);continue}s&&n&&s.isVector2&&n.isVector2||s&&n&&s.isVector3&&n.isVector3||s&&n&&s.isMatrix3&&n.isMatrix3?s.copy(n):this[t]=n}}toJSON(e){let t=e===void 0||typeof e=="string";if(!t&&e.textures[this.uuid]!==void 0)return e.textures[this.uuid];let n={metadata:{version:4.7,type:"Texture",generator:"Texture.toJSON"},uuid:this.uuid,name:this.name,image:this.source.toJSON(e).uuid,mapping:this.mapping,channel:this.channel,repeat:[this.repeat.x,this.repeat.y],offset:[this.offset.x,this.offset.y],center:[this.center.x,this.center.y],rotation:this.rotation,wrap:[this.wrapS,this.wrapT],format:this.format,internalFormat:this.internalFormat,type:this.type,normalized:this.normalized,colorSpace:this.colorSpace,minFilter:this.minFilter,magFilter:this.magFilter,anisotropy:this.anisotropy,flipY:this.flipY,generateMipmaps:this.generateMipmaps,mipmapsAutoUpdate:this.mipmapsAutoUpdate,premultiplyAlpha:this.premultiplyAlpha,unpackAlignment:this.unpackAlignment};return Object.keys(this.userData).length>0&&(n.userData=this.userData),t||(e.textures[this.uuid]=n),n}dispose(){this.dispatchEvent({type:"dispose"})}transformUv(e){if(this.mapping!==Tl)return e;if(e.applyMatrix3(this.matrix),e.x<0||e.x>1)switch(this.wrapS){case Qr:e.x=e.x-Math.floor(e.x);break;case An:e.x=e.x<0?0:1;break;case eo:Math.abs(Math.floor(e.x)%2)===1?e.x=Math.ceil(e.x)-e.x:e.x=e.x-Math.floor(e.x);break}if(e.y<0||e.y>1)switch(this.wrapT){case Qr:e.y=e.y-Math.floor(e.y);break;case An:e.y=e.y<0?0:1;break;case eo:Math.abs(Math.floor(e.y)%2)===1?e.y=Math.ceil(e.y)-e.y:e.y=e.y-Math.floor(e.y);break}return this.flipY&&(e.y=1-e.y),e}set needsUpdate(e){e===!0&&(this.version++,this.source.needsUpdate=!0)}set needsPMREMUpdate(e){e===!0&&this.pmremVersion++}};Yt.DEFAULT_IMAGE=null;Yt.DEFAULT_MAPPING=Tl;Yt.DEFAULT_ANISOTROPY=1;var dt=class{static{this.prototype.isVector4=!0}constructor(e=0,t=0,n=0,s=1){this.x=e,this.y=t,this.z=n,this.w=s}get width(){return this.z}set width(e){this.z=e}get height(){return this.w}set height(e){this.w=e}set(e,t,n,s){return this.x=e,this.y=t,this.z=n,this.w=s,this}setScalar(e){return this.x=e,this.y=e,this.z=e,this.w=e,this}setX(e){return this.x=e,this}setY(e){return this.y=e,this}setZ(e){return this.z=e,this}setW(e){return this.w=e,this}setComponent(e,t){switch(e){case 0:this.x=t;break;case 1:this.y=t;break;case 2:this.z=t;break;case 3:this.w=t;break;default:throw new Error("THREE.Vector4: index is out of range: "+e)}return this}getComponent(e){switch(e){case 0:return this.x;case 1:return this.y;case 2:return this.z;case 3:return this.w;default:throw new Error("THREE.Vector4: index is out of range: "+e)}}clone(){return new this.constructor(this.x,this.y,this.z,this.w)}copy(e){return this.x=e.x,this.y=e.y,this.z=e.z,this.w=e.w!==void 0?e.w:1,this}add(e){return this.x+=e.x,this.y+=e.y,this.z+=e.z,this.w+=e.w,this}addScalar(e){return this.x+=e,this.y+=e,this.z+=e,this.w+=e,this}addVectors(e,t){return this.x=e.x+t.x,this.y=e.y+t.y,this.z=e.z+t.z,this.w=e.w+t.w,this}addScaledVector(e,t){return this.x+=e.x*t,this.y+=e.y*t,this.z+=e.z*t,this.w+=e.w*t,this}sub(e){return this.x-=e.x,this.y-=e.y,this.z-=e.z,this.w-=e.w,this}subScalar(e){return this.x-=e,this.y-=e,this.z-=e,this.w-=e,this}subVectors(e,t){return this.x=e.x-t.x,this.y=e.y-t.y,this.z=e.z-t.z,this.w=e.w-t.w,this}multiply(e){return this.x*=e.x,this.y*=e.y,this.z*=e.z,this.w*=e.w,this}multiplyScalar(e){return this.x*=e,this.y*=e,this.z*=e,this.w*=e,this}applyMatrix4(e){let t=this.x,n=this.y,s=this.z,r=this.w,o=e.elements;return this.x=o[0]*t+o[4]*n+o[8]*s+o[12]*r,this.y=o[1]*t+o[5]*n+o[9]*s+o[13]*r,this.z=o[2]*t+o[6]*n+o[10]*s+o[14]*r,this.w=o[3]*t+o[7]*n+o[11]*s+o[15]*r,this}divide(e){return this.x/=e.x,this.y/=e.y,this.z/=e.z,this.w/=e.w,this}divideScalar(e){return this.multiplyScalar(1/e)}setAxisAngleFromQuaternion(e){this.w=2*Math.acos(e.w);let t=Math.sqrt(1-e.w*e.w);return t<1e-4?(this.x=1,this.y=0,this.z=0):(this.x=e.x/t,this.y=e.y/t,this.z=e.z/t),this}setAxisAngleFromRotationMatrix(e){let t,n,s,r,l=e.elements,c=l[0],h=l[4],d=l[8],u=l[1],f=l[5],v=l[9],S=l[2],m=l[6],p=l[10];if(Math.abs(h-u)<.01&&Math.abs(d-S)<.01&&Math.abs(v-m)<.01){if(Math.abs(h+u)<.1&&Math.abs(d+S)<.1&&Math.abs(v+m)<.1&&Math.abs(c+f+p-3)<.1)return this.set(1,0,0,0),this;t=Math.PI;let R=(c+1)/2,w=(f+1)/2,T=(p+1)/2,E=(h+u)/4,g=(d+S)/4,b=(v+m)/4;return R>w&&R>T?R<.01?(n=0,s=.707106781,r=.707106781):(n=Math.sqrt(R),s=E/n,r=g/n):w>T?w<.01?(n=.707106781,s=0,r=.707106781):(s=Math.sqrt(w),n=E/s,r=b/s):T<.01?(n=.707106781,s=.707106781,r=0):(r=Math.sqrt(T),n=g/r,s=b/r),this.set(n,s,r,t),this}let _=Math.sqrt((m-v)*(m-v)+(d-S)*(d-S)+(u-h)*(u-h));return Math.abs(_)<.001&&(_=1),this.x=(m-v)/_,this.y=(d-S)/_,this.z=(u-h)/_,this.w=Math.acos((c+f+p-1)/2),this}setFromMatrixPosition(e){let t=e.elements;return this.x=t[12],this.y=t[13],this.z=t[14],this.w=t[15],this}min(e){return this.x=Math.min(this.x,e.x),this.y=Math.min(this.y,e.y),this.z=Math.min(this.z,e.z),this.w=Math.min(this.w,e.w),this}max(e){return this.x=Math.max(this.x,e.x),this.y=Math.max(this.y,e.y),this.z=Math.max(this.z,e.z),this.w=Math.max(this.w,e.w),this}clamp(e,t){return this.x=He(this.x,e.x,t.x),this.y=He(this.y,e.y,t.y),this.z=He(this.z,e.z,t.z),this.w=He(this.w,e.w,t.w),this}clampScalar(e,t){return this.x=He(this.x,e,t),this.y=He(this.y,e,t),this.z=He(this.z,e,t),this.w=He(this.w,e,t),this}clampLength(e,t){let n=this.length();return this.divideScalar(n||1).multiplyScalar(He(n,e,t))}floor(){return this.x=Math.floor(this.x),this.y=Math.floor(this.y),this.z=Math.floor(this.z),this.w=Math.floor(this.w),this}ceil(){return this.x=Math.ceil(this.x),this.y=Math.ceil(this.y),this.z=Math.ceil(this.z),this.w=Math.ceil(this.w),this}round(){return this.x=Math.round(this.x),this.y=Math.round(this.y),this.z=Math.round(this.z),this.w=Math.round(this.w),this}roundToZero(){return this.x=Math.trunc(this.x),this.y=Math.trunc(this.y),this.z=Math.trunc(this.z),this.w=Math.trunc(this.w),this}negate(){return this.x=-this.x,this.y=-this.y,this.z=-this.z,this.w=-this.w,this}dot(e){return this.x*e.x+this.y*e.y+this.z*e.z+this.w*e.w}lengthSq(){return this.x*this.x+this.y*this.y+this.z*this.z+this.w*this.w}length(){return Math.sqrt(this.x*this.x+this.y*this.y+this.z*this.z+this.w*this.w)}manhattanLength(){return Math.abs(this.x)+Math.abs(this.y)+Math.abs(this.z)+Math.abs(this.w)}normalize(){return this.divideScalar(this.length()||1)}setLength(e){return this.normalize().multiplyScalar(e)}lerp(e,t){return this.x+=(e.x-this.x)*t,this.y+=(e.y-this.y)*t,this.z+=(e.z-this.z)*t,this.w+=(e.w-this.w)*t,this}lerpVectors(e,t,n){return this.x=e.x+(t.x-e.x)*n,this.y=e.y+(t.y-e.y)*n,this.z=e.z+(t.z-e.z)*n,this.w=e.w+(t.w-e.w)*n,this}equals(e){return e.x===this.x&&e.y===this.y&&e.z===this.z&&e.w===this.w}fromArray(e,t=0){return this.x=e[t],this.y=e[t+1],this.z=e[t+2],this.w=e[t+3],this}toArray(e=[],t=0){return e[t]=this.x,e[t+1]=this.y,e[t+2]=this.z,e[t+3]=this.w,e}fromBufferAttribute(e,t){return this.x=e.getX(t),this.y=e.getY(t),this.z=e.getZ(t),this.w=e.getW(t),this}random(){return this.x=Math.random(),this.y=Math.random(),this.z=Math.random(),this.w=Math.random(),this}*[Symbol.iterator](){yield this.x,yield this.y,yield this.z,yield this.w}},io=class extends xn{constructor(e=1,t=1,n={}){super(),n=Object.assign({generateMipmaps:!1,internalFormat:null,minFilter:Vt,depthBuffer:!0,stencilBuffer:!1,resolveColorBuffer:!0,resolveDepthBuffer:!0,resolveStencilBuffer:!0,storeMultisampledColorBuffer:!0,storeMultisampledDepthBuffer:!0,storeMultisampledStencilBuffer:!0,depthTexture:null,samples:0,count:1,depth:1,multiview:!1,useArrayDepthTexture:!1},n),this.isRenderTarget=!0,this.width=e,this.height=t,this.depth=n.depth,this.scissor=new dt(0,0,e,t),this.scissorTest=!1,this.viewport=new dt(0,0,e,t),this.textures=[];let s=n.count;for(let r=0;r<s;r++)this.textures[r]=new Yt({width:e,height:t,depth:n.depth}),this.textures[r].isRenderTargetTexture=!0,this.textures[r].renderTarget=this;this.$e(n),this.depthBuffer=n.depthBuffer,this.stencilBuffer=n.stencilBuffer,this.resolveColorBuffer=n.resolveColorBuffer,this.resolveDepthBuffer=n.resolveDepthBuffer,this.resolveStencilBuffer=n.resolveStencilBuffer,this.storeMultisampledColorBuffer=n.storeMultisampledColorBuffer,this.storeMultisampledDepthBuffer=n.storeMultisampledDepthBuffer,this.storeMultisampledStencilBuffer=n.storeMultisampledStencilBuffer,this.Ze=null,this.depthTexture=n.depthTexture,this.samples=n.samples,this.multiview=n.multiview,this.useArrayDepthTexture=n.useArrayDepthTexture}$e(e={}){let t={minFilter:Vt,generateMipmaps:!1,flipY:!1,internalFormat:null};e.mapping!==void 0&&(t.mapping=e.mapping),e.wrapS!==void 0&&(t.wrapS=e.wrapS),e.wrapT!==void 0&&(t.wrapT=e.wrapT),e.wrapR!==void 0&&(t.wrapR=e.wrapR),e.magFilter!==void 0&&(t.magFilter=e.magFilter),e.minFilter!==void 0&&(t.minFilter=e.minFilter),e.format!==void 0&&(t.format=e.format),e.type!==void 0&&(t.type=e.type),e.anisotropy!==void 0&&(t.anisotropy=e.anisotropy),e.colorSpace!==void 0&&(t.colorSpace=e.colorSpace),e.flipY!==void 0&&(t.flipY=e.flipY),e.generateMipmaps!==void 0&&(t.generateMipmaps=e.generateMipmaps),e.mipmapsAutoUpdate!==void 0&&(t.mipmapsAutoUpdate=e.mipmapsAutoUpdate),e.internalFormat!==void 0&&(t.internalFormat=e.internalFormat);for(let n=0;n<this.textures.length;n++)this.textures[n].setValues(t)}get texture(){return this.textures[0]}set texture(e){this.textures[0]=e}set depthTexture(e){this.Ze!==null&&this.Ze.renderTarget===this&&(this.Ze.renderTarget=null),e!==null&&e.renderTarget===null&&(e.renderTarget=this),this.Ze=e}get depthTexture(){return this.Ze}setSize(e,t,n=1){if(this.width!==e||this.height!==t||this.depth!==n){this.width=e,this.height=t,this.depth=n;for(let s=0,r=this.textures.length;s<r;s++)this.textures[s].image.width=e,this.textures[s].image.height=t,this.textures[s].image.depth=n,this.textures[s].isData3DTexture!==!0&&(this.textures[s].isArrayTexture=this.textures[s].image.depth>1);this.dispose()}this.viewport.set(0,0,e,t),this.scissor.set(0,0,e,t)}clone(){return new this.constructor().copy(this)}copy(e){this.width=e.width,this.height=e.height,this.depth=e.depth,this.scissor.copy(e.scissor),this.scissorTest=e.scissorTest,this.viewport.copy(e.viewport),this.textures.length=0;for(let t=0,n=e.textures.length;t<n;t++){this.textures[t]=e.textures[t].clone(),this.textures[t].isRenderTargetTexture=!0,this.textures[t].renderTarget=this;let s=Object.assign({},e.textures[t].image);this.textures[t].source=new is(s)}if(this.depthBuffer=e.depthBuffer,this.stencilBuffer=e.stencilBuffer,this.resolveColorBuffer=e.resolveColorBuffer,this.resolveDepthBuffer=e.resolveDepthBuffer,this.resolveStencilBuffer=e.resolveStencilBuffer,this.storeMultisampledColorBuffer=e.storeMultisampledColorBuffer,this.storeMultisampledDepthBuffer=e.storeMultisampledDepthBuffer,this.storeMultisampledStencilBuffer=e.storeMultisampledStencilBuffer,e.depthTexture!==null)if(e.depthTexture.renderTarget===e){let t=e.depthTexture.clone();t.renderTarget=null,this.depthTexture=t}else this.depthTexture=e.depthTexture;else this.depthTexture=null;return this.samples=e.samples,this.multiview=e.multiview,this.useArrayDepthTexture=e.useArrayDepthTexture,this}dispose(){this.dispatchEvent({type:"dispose"})}},tn=class extends io{constructor(e=1,t=1,n={}){super(e,t,n),this.isWebGLRenderTarget=!0}},Us=class extends Yt{constructor(e=null,t=1,n=1,s=1){super(null),this.isDataArrayTexture=!0,this.image={data:e,width:t,height:n,depth:s},this.magFilter=Tt,this.minFilter=Tt,this.wrapR=An,this.generateMipmaps=!1,this.flipY=!1,this.unpackAlignment=1,this.layerUpdates=new Set}copy(e){return super.copy(e),this.wrapR=e.wrapR,this}addLayerUpdate(e){this.layerUpdates.add(e)}clearLayerUpdates(){this.layerUpdates.clear()}};var so=class extends Yt{constructor(e=null,t=1,n=1,s=1){super(null),this.isData3DTexture=!0,this.image={data:e,width:t,height:n,depth:s},this.magFilter=Tt,this.minFilter=Tt,this.wrapR=An,this.generateMipmaps=!1,this.flipY=!1,this.unpackAlignment=1}copy(e){return super.copy(e),this.wrapR=e.wrapR,this}};var lt=class i{static{this.prototype.isMatrix4=!0}constructor(e,t,n,s,r,o,a,l,c,h,d,u,f,v,S,m){this.elements=[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1],e!==void 0&&this.set(e,t,n,s,r,o,a,l,c,h,d,u,f,v,S,m)}set(e,t,n,s,r,o,a,l,c,h,d,u,f,v,S,m){let p=this.elements;return p[0]=e,p[4]=t,p[8]=n,p[12]=s,p[1]=r,p[5]=o,p[9]=a,p[13]=l,p[2]=c,p[6]=h,p[10]=d,p[14]=u,p[3]=f,p[7]=v,p[11]=S,p[15]=m,this}identity(){return this.set(1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1),this}clone(){return new i().fromArray(this.elements)}copy(e){let t=this.elements,n=e.elements;return t[0]=n[0],t[1]=n[1],t[2]=n[2],t[3]=n[3],t[4]=n[4],t[5]=n[5],t[6]=n[6],t[7]=n[7],t[8]=n[8],t[9]=n[9],t[10]=n[10],t[11]=n[11],t[12]=n[12],t[13]=n[13],t[14]=n[14],t[15]=n[15],this}copyPosition(e){let t=this.elements,n=e.elements;return t[12]=n[12],t[13]=n[13],t[14]=n[14],this}setFromMatrix3(e){let t=e.elements;return this.set(t[0],t[3],t[6],0,t[1],t[4],t[7],0,t[2],t[5],t[8],0,0,0,0,1),this}extractBasis(e,t,n){return this.determinantAffine()===0?(e.set(1,0,0),t.set(0,1,0),n.set(0,0,1),this):(e.setFromMatrixColumn(this,0),t.setFromMatrixColumn(this,1),n.setFromMatrixColumn(this,2),this)}makeBasis(e,t,n){return this.set(e.x,t.x,n.x,0,e.y,t.y,n.y,0,e.z,t.z,n.z,0,0,0,0,1),this}extractRotation(e){if(e.determinantAffine()===0)return this.identity();let t=this.elements,n=e.elements,s=1/Gi.setFromMatrixColumn(e,0).length(),r=1/Gi.setFromMatrixColumn(e,1).length(),o=1/Gi.setFromMatrixColumn(e,2).length();return t[0]=n[0]*s,t[1]=n[1]*s,t[2]=n[2]*s,t[3]=0,t[4]=n[4]*r,t[5]=n[5]*r,t[6]=n[6]*r,t[7]=0,t[8]=n[8]*o,t[9]=n[9]*o,t[10]=n[10]*o,t[11]=0,t[12]=0,t[13]=0,t[14]=0,t[15]=1,this}makeRotationFromEuler(e){let t=this.elements,n=e.x,s=e.y,r=e.z,o=Math.cos(n),a=Math.sin(n),l=Math.cos(s),c=Math.sin(s),h=Math.cos(r),d=Math.sin(r);if(e.order==="XYZ"){let u=o*h,f=o*d,v=a*h,S=a*d;t[0]=l*h,t[4]=-l*d,t[8]=c,t[1]=f+v*c,t[5]=u-S*c,t[9]=-a*l,t[2]=S-u*c,t[6]=v+f*c,t[10]=o*l}else if(e.order==="YXZ"){let u=l*h,f=l*d,v=c*h,S=c*d;t[0]=u+S*a,t[4]=v*a-f,t[8]=o*c,t[1]=o*d,t[5]=o*h,t[9]=-a,t[2]=f*a-v,t[6]=S+u*a,t[10]=o*l}else if(e.order==="ZXY"){let u=l*h,f=l*d,v=c*h,S=c*d;t[0]=u-S*a,t[4]=-o*d,t[8]=v+f*a,t[1]=f+v*a,t[5]=o*h,t[9]=S-u*a,t[2]=-o*c,t[6]=a,t[10]=o*l}else if(e.order==="ZYX"){let u=o*h,f=o*d,v=a*h,S=a*d;t[0]=l*h,t[4]=v*c-f,t[8]=u*c+S,t[1]=l*d,t[5]=S*c+u,t[9]=f*c-v,t[2]=-c,t[6]=a*l,t[10]=o*l}else if(e.order==="YZX"){let u=o*l,f=o*c,v=a*l,S=a*c;t[0]=l*h,t[4]=S-u*d,t[8]=v*d+f,t[1]=d,t[5]=o*h,t[9]=-a*h,t[2]=-c*h,t[6]=f*d+v,t[10]=u-S*d}else if(e.order==="XZY"){let u=o*l,f=o*c,v=a*l,S=a*c;t[0]=l*h,t[4]=-d,t[8]=c*h,t[1]=u*d+S,t[5]=o*h,t[9]=f*d-v,t[2]=v*d-f,t[6]=a*h,t[10]=S*d+u}return t[3]=0,t[7]=0,t[11]=0,t[12]=0,t[13]=0,t[14]=0,t[15]=1,this}makeRotationFromQuaternion(e){return this.compose(Lf,e,If)}lookAt(e,t,n){let s=this.elements;return jt.subVectors(e,t),jt.lengthSq()===0&&(jt.z=1),jt.normalize(),ii.crossVectors(n,jt),ii.lengthSq()===0&&(Math.abs(n.z)===1?jt.x+=1e-4:jt.z+=1e-4,jt.normalize(),ii.crossVectors(n,jt)),ii.normalize(),Sr.crossVectors(jt,ii),s[0]=ii.x,s[4]=Sr.x,s[8]=jt.x,s[1]=ii.y,s[5]=Sr.y,s[9]=jt.y,s[2]=ii.z,s[6]=Sr.z,s[10]=jt.z,this}multiply(e){return this.multiplyMatrices(this,e)}premultiply(e){return this.multiplyMatrices(e,this)}multiplyMatrices(e,t){let n=e.elements,s=t.elements,r=this.elements,o=n[0],a=n[4],l=n[8],c=n[12],h=n[1],d=n[5],u=n[9],f=n[13],v=n[2],S=n[6],m=n[10],p=n[14],_=n[3],R=n[7],w=n[11],T=n[15],E=s[0],g=s[4],b=s[8],k=s[12],L=s[1],D=s[5],G=s[9],$=s[13],P=s[2],q=s[6],K=s[10],V=s[14],re=s[3],X=s[7],te=s[11],ie=s[15];return r[0]=o*E+a*L+l*P+c*re,r[4]=o*g+a*D+l*q+c*X,r[8]=o*b+a*G+l*K+c*te,r[12]=o*k+a*$+l*V+c*ie,r[1]=h*E+d*L+u*P+f*re,r[5]=h*g+d*D+u*q+f*X,r[9]=h*b+d*G+u*K+f*te,r[13]=h*k+d*$+u*V+f*ie,r[2]=v*E+S*L+m*P+p*re,r[6]=v*g+S*D+m*q+p*X,r[10]=v*b+S*G+m*K+p*te,r[14]=v*k+S*$+m*V+p*ie,r[3]=_*E+R*L+w*P+T*re,r[7]=_*g+R*D+w*q+T*X,r[11]=_*b+R*G+w*K+T*te,r[15]=_*k+R*$+w*V+T*ie,this}multiplyScalar(e){let t=this.elements;return t[0]*=e,t[4]*=e,t[8]*=e,t[12]*=e,t[1]*=e,t[5]*=e,t[9]*=e,t[13]*=e,t[2]*=e,t[6]*=e,t[10]*=e,t[14]*=e,t[3]*=e,t[7]*=e,t[11]*=e,t[15]*=e,this}determinant(){let e=this.elements,t=e[0],n=e[4],s=e[8],r=e[12],o=e[1],a=e[5],l=e[9],c=e[13],h=e[2],d=e[6],u=e[10],f=e[14],v=e[3],S=e[7],m=e[11],p=e[15],_=l*f-c*u,R=a*f-c*d,w=a*u-l*d,T=o*f-c*h,E=o*u-l*h,g=o*d-a*h;return t*(S*_-m*R+p*w)-n*(v*_-m*T+p*E)+s*(v*R-S*T+p*g)-r*(v*w-S*E+m*g)}determinantAffine(){let e=this.elements,t=e[0],n=e[4],s=e[8],r=e[1],o=e[5],a=e[9],l=e[2],c=e[6],h=e[10];return t*(o*h-a*c)-n*(r*h-a*l)+s*(r*c-o*l)}transpose(){let e=this.elements,t;return t=e[1],e[1]=e[4],e[4]=t,t=e[2],e[2]=e[8],e[8]=t,t=e[6],e[6]=e[9],e[9]=t,t=e[3],e[3]=e[12],e[12]=t,t=e[7],e[7]=e[13],e[13]=t,t=e[11],e[11]=e[14],e[14]=t,this}setPosition(e,t,n){let s=this.elements;return e.isVector3?(s[12]=e.x,s[13]=e.y,s[14]=e.z):(s[12]=e,s[13]=t,s[14]=n),this}invert(){let e=this.elements,t=e[0],n=e[1],s=e[2],r=e[3],o=e[4],a=e[5],l=e[6],c=e[7],h=e[8],d=e[9],u=e[10],f=e[11],v=e[12],S=e[13],m=e[14],p=e[15],_=t*a-n*o,R=t*l-s*o,w=t*c-r*o,T=n*l-s*a,E=n*c-r*a,g=s*c-r*l,b=h*S-d*v,k=h*m-u*v,L=h*p-f*v,D=d*m-u*S,G=d*p-f*S,$=u*p-f*m,P=_*$-R*G+w*D+T*L-E*k+g*b;if(P===0)return this.set(0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0);let q=1/P;return e[0]=(a*$-l*G+c*D)*q,e[1]=(s*G-n*$-r*D)*q,e[2]=(S*g-m*E+p*T)*q,e[3]=(u*E-d*g-f*T)*q,e[4]=(l*L-o*$-c*k)*q,e[5]=(t*$-s*L+r*k)*q,e[6]=(m*w-v*g-p*R)*q,e[7]=(h*g-u*w+f*R)*q,e[8]=(o*G-a*L+c*b)*q,e[9]=(n*L-t*G-r*b)*q,e[10]=(v*E-S*w+p*_)*q,e[11]=(d*w-h*E-f*_)*q,e[12]=(a*k-o*D-l*b)*q,e[13]=(t*D-n*k+s*b)*q,e[14]=(S*R-v*T-m*_)*q,e[15]=(h*T-d*R+u*_)*q,this}scale(e){let t=this.elements,n=e.x,s=e.y,r=e.z;return t[0]*=n,t[4]*=s,t[8]*=r,t[1]*=n,t[5]*=s,t[9]*=r,t[2]*=n,t[6]*=s,t[10]*=r,t[3]*=n,t[7]*=s,t[11]*=r,this}getMaxScaleOnAxis(){let e=this.elements,t=e[0]*e[0]+e[1]*e[1]+e[2]*e[2],n=e[4]*e[4]+e[5]*e[5]+e[6]*e[6],s=e[8]*e[8]+e[9]*e[9]+e[10]*e[10];return Math.sqrt(Math.max(t,n,s))}makeTranslation(e,t,n){return e.isVector3?this.set(1,0,0,e.x,0,1,0,e.y,0,0,1,e.z,0,0,0,1):this.set(1,0,0,e,0,1,0,t,0,0,1,n,0,0,0,1),this}makeRotationX(e){let t=Math.cos(e),n=Math.sin(e);return this.set(1,0,0,0,0,t,-n,0,0,n,t,0,0,0,0,1),this}makeRotationY(e){let t=Math.cos(e),n=Math.sin(e);return this.set(t,0,n,0,0,1,0,0,-n,0,t,0,0,0,0,1),this}makeRotationZ(e){let t=Math.cos(e),n=Math.sin(e);return this.set(t,-n,0,0,n,t,0,0,0,0,1,0,0,0,0,1),this}makeRotationAxis(e,t){let n=Math.cos(t),s=Math.sin(t),r=1-n,o=e.x,a=e.y,l=e.z,c=r*o,h=r*a;return this.set(c*o+n,c*a-s*l,c*l+s*a,0,c*a+s*l,h*a+n,h*l-s*o,0,c*l-s*a,h*l+s*o,r*l*l+n,0,0,0,0,1),this}makeScale(e,t,n){return this.set(e,0,0,0,0,t,0,0,0,0,n,0,0,0,0,1),this}makeShear(e,t,n,s,r,o){return this.set(1,n,r,0,e,1,o,0,t,s,1,0,0,0,0,1),this}compose(e,t,n){let s=this.elements,r=t.e,o=t.o,a=t.v,l=t.S,c=r+r,h=o+o,d=a+a,u=r*c,f=r*h,v=r*d,S=o*h,m=o*d,p=a*d,_=l*c,R=l*h,w=l*d,T=n.x,E=n.y,g=n.z;return s[0]=(1-(S+p))*T,s[1]=(f+w)*T,s[2]=(v-R)*T,s[3]=0,s[4]=(f-w)*E,s[5]=(1-(u+p))*E,s[6]=(m+_)*E,s[7]=0,s[8]=(v+R)*g,s[9]=(m-_)*g,s[10]=(1-(u+S))*g,s[11]=0,s[12]=e.x,s[13]=e.y,s[14]=e.z,s[15]=1,this}decompose(e,t,n){let s=this.elements;e.x=s[12],e.y=s[13],e.z=s[14];let r=this.determinantAffine();if(r===0)return n.set(1,1,1),t.identity(),this;let o=Gi.set(s[0],s[1],s[2]).length(),a=Gi.set(s[4],s[5],s[6]).length(),l=Gi.set(s[8],s[9],s[10]).length();r<0&&(o=-o),mn.copy(this);let c=1/o,h=1/a,d=1/l;return mn.elements[0]*=c,mn.elements[1]*=c,mn.elements[2]*=c,mn.elements[4]*=h,mn.elements[5]*=h,mn.elements[6]*=h,mn.elements[8]*=d,mn.elements[9]*=d,mn.elements[10]*=d,t.setFromRotationMatrix(mn),n.x=o,n.y=a,n.z=l,this}makePerspective(e,t,n,s,r,o,a=hn,l=!1){let c=this.elements,h=2*r/(t-e),d=2*r/(n-s),u=(t+e)/(t-e),f=(n+s)/(n-s),v,S;if(l)v=r/(o-r),S=o*r/(o-r);else if(a===hn)v=-(o+r)/(o-r),S=-2*o*r/(o-r);else if(a===Ns)v=-o/(o-r),S=-o*r/(o-r);else throw new Error("THREE.Matrix4.makePerspective(): Invalid coordinate system: "+a);return c[0]=h,c[4]=0,c[8]=u,c[12]=0,c[1]=0,c[5]=d,c[9]=f,c[13]=0,c[2]=0,c[6]=0,c[10]=v,c[14]=S,c[3]=0,c[7]=0,c[11]=-1,c[15]=0,this}makeOrthographic(e,t,n,s,r,o,a=hn,l=!1){let c=this.elements,h=2/(t-e),d=2/(n-s),u=-(t+e)/(t-e),f=-(n+s)/(n-s),v,S;if(l)v=1/(o-r),S=o/(o-r);else if(a===hn)v=-2/(o-r),S=-(o+r)/(o-r);else if(a===Ns)v=-1/(o-r),S=-r/(o-r);else throw new Error("THREE.Matrix4.makeOrthographic(): Invalid coordinate system: "+a);return c[0]=h,c[4]=0,c[8]=0,c[12]=u,c[1]=0,c[5]=d,c[9]=0,c[13]=f,c[2]=0,c[6]=0,c[10]=v,c[14]=S,c[3]=0,c[7]=0,c[11]=0,c[15]=1,this}equals(e){let t=this.elements,n=e.elements;for(let s=0;s<16;s++)if(t[s]!==n[s])return!1;return!0}fromArray(e,t=0){for(let n=0;n<16;n++)this.elements[n]=e[n+t];return this}toArray(e=[],t=0){let n=this.elements;return e[t]=n[0],e[t+1]=n[1],e[t+2]=n[2],e[t+3]=n[3],e[t+4]=n[4],e[t+5]=n[5],e[t+6]=n[6],e[t+7]=n[7],e[t+8]=n[8],e[t+9]=n[9],e[t+10]=n[10],e[t+11]=n[11],e[t+12]=n[12],e[t+13]=n[13],e[t+14]=n[14],e[t+15]=n[15],e}},Gi=new N,mn=new lt,Lf=new N(0,0,0),If=new N(1,1,1),ii=new N,Sr=new N,jt=new N,th=new lt,nh=new en,ci=class i{constructor(e=0,t=0,n=0,s=i.DEFAULT_ORDER){this.isEuler=!0,this.e=e,this.o=t,this.v=n,this.U=s}get x(){return this.e}set x(e){this.e=e,this.A()}get y(){return this.o}set y(e){this.o=e,this.A()}get z(){return this.v}set z(e){this.v=e,this.A()}get order(){return this.U}set order(e){this.U=e,this.A()}set(e,t,n,s=this.U){return this.e=e,this.o=t,this.v=n,this.U=s,this.A(),this}clone(){return new this.constructor(this.e,this.o,this.v,this.U)}copy(e){return this.e=e.e,this.o=e.o,this.v=e.v,this.U=e.U,this.A(),this}setFromRotationMatrix(e,t=this.U,n=!0){let s=e.elements,r=s[0],o=s[4],a=s[8],l=s[1],c=s[5],h=s[9],d=s[2],u=s[6],f=s[10];switch(t){case"XYZ":this.o=Math.asin(He(a,-1,1)),Math.abs(a)<.9999999?(this.e=Math.atan2(-h,f),this.v=Math.atan2(-o,r)):(this.e=Math.atan2(u,c),this.v=0);break;case"YXZ":this.e=Math.asin(-He(h,-1,1)),Math.abs(h)<.9999999?(this.o=Math.atan2(a,f),this.v=Math.atan2(l,c)):(this.o=Math.atan2(-d,r),this.v=0);break;case"ZXY":this.e=Math.asin(He(u,-1,1)),Math.abs(u)<.9999999?(this.o=Math.atan2(-d,f),this.v=Math.atan2(-o,c)):(this.o=0,this.v=Math.atan2(l,r));break;case"ZYX":this.o=Math.asin(-He(d,-1,1)),Math.abs(d)<.9999999?(this.e=Math.atan2(u,f),this.v=Math.atan2(l,r)):(this.e=0,this.v=Math.atan2(-o,c));break;case"YZX":this.v=Math.asin(He(l,-1,1)),Math.abs(l)<.9999999?(this.e=Math.atan2(-h,c),this.o=Math.atan2(-d,r)):(this.e=0,this.o=Math.atan2(a,f));break;case"XZY":this.v=Math.asin(-He(o,-1,1)),Math.abs(o)<.9999999?(this.e=Math.atan2(u,c),this.o=Math.atan2(a,r)):(this.e=Math.atan2(-h,f),this.o=0);break;default:Ce("Euler: .setFromRotationMatrix() encountered an unknown order: "+t)}return this.U=t,n===!0&&this.A(),this}setFromQuaternion(e,t,n){return th.makeRotationFromQuaternion(e),this.setFromRotationMatrix(th,t,n)}setFromVector3(e,t=this.U){return this.set(e.x,e.y,e.z,t)}reorder(e){return nh.setFromEuler(this),this.setFromQuaternion(nh,e)}equals(e){return e.e===this.e&&e.o===this.o&&e.v===this.v&&e.U===this.U}fromArray(e){return this.e=e[0],this.o=e[1],this.v=e[2],e[3]!==void 0&&(this.U=e[3]),this.A(),this}toArray(e=[],t=0){return e[t]=this.e,e[t+1]=this.o,e[t+2]=this.v,e[t+3]=this.U,e}Ut(e){return this.A=e,this}A(){}*[Symbol.iterator](){yield this.e,yield this.o,yield this.v,yield this.U}};ci.DEFAULT_ORDER="XYZ";var Os=class{constructor(){this.mask=1}set(e){this.mask=(1<<e|0)>>>0}enable(e){this.mask|=1<<e|0}enableAll(){this.mask=-1}toggle(e){this.mask^=1<<e|0}disable(e){this.mask&=~(1<<e|0)}disableAll(){this.mask=0}test(e){return(this.mask&e.mask)!==0}isEnabled(e){return(this.mask&(1<<e|0))!==0}},Nf=0,ih=new N,Vi=new en,On=new lt,Mr=new N,bs=new N,Df=new N,Uf=new en,sh=new N(1,0,0),rh=new N(0,1,0),oh=new N(0,0,1),ah={type:"added"},Of={type:"removed"},Hi={type:"childadded",child:null},Wa={type:"childremoved",child:null},$t=class i extends xn{constructor(){super(),this.isObject3D=!0,Object.defineProperty(this,"id",{value:Nf++}),this.uuid=fs(),this.name="",this.type="Object3D",this.parent=null,this.children=[],this.up=i.DEFAULT_UP.clone();let e=new N,t=new ci,n=new en,s=new N(1,1,1);function r(){n.setFromEuler(t,!1)}function o(){t.setFromQuaternion(n,void 0,!1)}t.Ut(r),n.Ut(o),Object.defineProperties(this,{position:{configurable:!0,enumerable:!0,value:e},rotation:{configurable:!0,enumerable:!0,value:t},quaternion:{configurable:!0,enumerable:!0,value:n},scale:{configurable:!0,enumerable:!0,value:s},modelViewMatrix:{value:new lt},normalMatrix:{value:new Ue}}),this.matrix=new lt,this.matrixWorld=new lt,this.matrixAutoUpdate=i.DEFAULT_MATRIX_AUTO_UPDATE,this.matrixWorldAutoUpdate=i.DEFAULT_MATRIX_WORLD_AUTO_UPDATE,this.matrixWorldNeedsUpdate=!1,this.layers=new Os,this.visible=!0,this.castShadow=!1,this.receiveShadow=!1,this.frustumCulled=!0,this.renderOrder=0,this.animations=[],this.customDepthMaterial=void 0,this.customDistanceMaterial=void 0,this.static=!1,this.userData={},this.pivot=null}onBeforeShadow(){}onAfterShadow(){}onBeforeRender(){}onAfterRender(){}applyMatrix4(e){this.matrixAutoUpdate&&this.updateMatrix(),this.matrix.premultiply(e),this.matrix.decompose(this.position,this.quaternion,this.scale),this.pivot!==null&&this.position.copy(this.pivot).applyMatrix4(this.matrix).sub(this.pivot)}applyQuaternion(e){return this.quaternion.premultiply(e),this}setRotationFromAxisAngle(e,t){this.quaternion.setFromAxisAngle(e,t)}setRotationFromEuler(e){this.quaternion.setFromEuler(e,!0)}setRotationFromMatrix(e){this.quaternion.setFromRotationMatrix(e)}setRotationFromQuaternion(e){this.quaternion.copy(e)}rotateOnAxis(e,t){return Vi.setFromAxisAngle(e,t),this.quaternion.multiply(Vi),this}rotateOnWorldAxis(e,t){return Vi.setFromAxisAngle(e,t),this.quaternion.premultiply(Vi),this}rotateX(e){return this.rotateOnAxis(sh,e)}rotateY(e){return this.rotateOnAxis(rh,e)}rotateZ(e){return this.rotateOnAxis(oh,e)}translateOnAxis(e,t){return ih.copy(e).applyQuaternion(this.quaternion),this.position.add(ih.multiplyScalar(t)),this}translateX(e){return this.translateOnAxis(sh,e)}translateY(e){return this.translateOnAxis(rh,e)}translateZ(e){return this.translateOnAxis(oh,e)}localToWorld(e){return this.updateWorldMatrix(!0,!1),e.applyMatrix4(this.matrixWorld)}worldToLocal(e){return this.updateWorldMatrix(!0,!1),e.applyMatrix4(On.copy(this.matrixWorld).invert())}lookAt(e,t,n){e.isVector3?Mr.copy(e):Mr.set(e,t,n);let s=this.parent;this.updateWorldMatrix(!0,!1),bs.setFromMatrixPosition(this.matrixWorld),this.isCamera||this.isLight?On.lookAt(bs,Mr,this.up):On.lookAt(Mr,bs,this.up),this.quaternion.setFromRotationMatrix(On),s&&(On.extractRotation(s.matrixWorld),Vi.setFromRotationMatrix(On),this.quaternion.premultiply(Vi.invert()))}add(e){if(arguments.length>1){for(let t=0;t<arguments.length;t++)this.add(arguments[t]);return this}return e===this?(Ne("Object3D.add: object can't be added as a child of itself.",e),this):(e&&e.isObject3D?(e.removeFromParent(),e.parent=this,this.children.push(e),e.dispatchEvent(ah),Hi.child=e,this.dispatchEvent(Hi),Hi.child=null):Ne("Object3D.add: object not an instance of THREE.Object3D.",e),this)}remove(e){if(arguments.length>1){for(let n=0;n<arguments.length;n++)this.remove(arguments[n]);return this}let t=this.children.indexOf(e);return t!==-1&&(e.parent=null,this.children.splice(t,1),e.dispatchEvent(Of),Wa.child=e,this.dispatchEvent(Wa),Wa.child=null),this}removeFromParent(){let e=this.parent;return e!==null&&e.remove(this),this}clear(){return this.remove(...this.children)}attach(e){return this.updateWorldMatrix(!0,!1),On.copy(this.matrixWorld).invert(),e.parent!==null&&(e.parent.updateWorldMatrix(!0,!1),On.multiply(e.parent.matrixWorld)),e.applyMatrix4(On),e.removeFromParent(),e.parent=this,this.children.push(e),e.updateWorldMatrix(!1,!0),e.dispatchEvent(ah),Hi.child=e,this.dispatchEvent(Hi),Hi.child=null,this}getObjectById(e){return this.getObjectByProperty("id",e)}getObjectByName(e){return this.getObjectByProperty("name",e)}getObjectByProperty(e,t){if(this[e]===t)return this;for(let n=0,s=this.children.length;n<s;n++){let o=this.children[n].getObjectByProperty(e,t);if(o!==void 0)return o}}getObjectsByProperty(e,t,n=[]){this[e]===t&&n.push(this);let s=this.children;for(let r=0,o=s.length;r<o;r++)s[r].getObjectsByProperty(e,t,n);return n}getWorldPosition(e){return this.updateWorldMatrix(!0,!1),e.setFromMatrixPosition(this.matrixWorld)}getWorldQuaternion(e){return this.updateWorldMatrix(!0,!1),this.matrixWorld.decompose(bs,e,Df),e}getWorldScale(e){return this.updateWorldMatrix(!0,!1),this.matrixWorld.decompose(bs,Uf,e),e}getWorldDirection(e){this.updateWorldMatrix(!0,!1);let t=this.matrixWorld.elements;return e.set(t[8],t[9],t[10]).normalize()}raycast(){}intersectsFrustum(){return!0}traverse(e){e(this);let t=this.children;for(let n=0,s=t.length;n<s;n++)t[n].traverse(e)}traverseVisible(e){if(this.visible===!1)return;e(this);let t=this.children;for(let n=0,s=t.length;n<s;n++)t[n].traverseVisible(e)}traverseAncestors(e){let t=this.parent;t!==null&&(e(t),t.traverseAncestors(e))}updateMatrix(){this.matrix.compose(this.position,this.quaternion,this.scale);let e=this.pivot;if(e!==null){let t=e.x,n=e.y,s=e.z,r=this.matrix.elements;r[12]+=t-r[0]*t-r[4]*n-r[8]*s,r[13]+=n-r[1]*t-r[5]*n-r[9]*s,r[14]+=s-r[2]*t-r[6]*n-r[10]*s}this.matrixWorldNeedsUpdate=!0}updateMatrixWorld(e){this.matrixAutoUpdate&&this.updateMatrix(),(this.matrixWorldNeedsUpdate||e)&&(this.matrixWorldAutoUpdate===!0&&(this.parent===null?this.matrixWorld.copy(this.matrix):this.matrixWorld.multiplyMatrices(this.parent.matrixWorld,this.matrix)),this.matrixWorldNeedsUpdate=!1,e=!0);let t=this.children;for(let n=0,s=t.length;n<s;n++)t[n].updateMatrixWorld(e)}updateWorldMatrix(e,t,n=!1){let s=this.parent;if(e===!0&&s!==null&&s.updateWorldMatrix(!0,!1),this.matrixAutoUpdate&&this.updateMatrix(),(this.matrixWorldNeedsUpdate||n)&&(this.matrixWorldAutoUpdate===!0&&(this.parent===null?this.matrixWorld.copy(this.matrix):this.matrixWorld.multiplyMatrices(this.parent.matrixWorld,this.matrix)),this.matrixWorldNeedsUpdate=!1,n=!0),t===!0){let r=this.children;for(let o=0,a=r.length;o<a;o++)r[o].updateWorldMatrix(!1,!0,n)}}toJSON(e){let t=e===void 0||typeof e=="string",n={};t&&(e={geometries:{},materials:{},textures:{},images:{},shapes:{},skeletons:{},animations:{},nodes:{}},n.metadata={version:4.7,type:"Object",generator:"Object3D.toJSON"});let s={};s.uuid=this.uuid,s.type=this.type,s.name=this.name,s.castShadow=this.castShadow,s.receiveShadow=this.receiveShadow,s.visible=this.visible,s.frustumCulled=this.frustumCulled,s.renderOrder=this.renderOrder,s.static=this.static,s.matrixAutoUpdate=this.matrixAutoUpdate,Object.keys(this.userData).length>0&&(s.userData=this.userData),s.layers=this.layers.mask,s.matrix=this.matrix.toArray(),s.up=this.up.toArray(),this.pivot!==null&&(s.pivot=this.pivot.toArray()),this.morphTargetDictionary!==void 0&&(s.morphTargetDictionary=Object.assign({},this.morphTargetDictionary)),this.morphTargetInfluences!==void 0&&(s.morphTargetInfluences=this.morphTargetInfluences.slice()),this.isInstancedMesh&&(s.type="InstancedMesh",s.count=this.count,s.instanceMatrix=this.instanceMatrix.toJSON(),this.instanceColor!==null&&(s.instanceColor=this.instanceColor.toJSON())),this.isBatchedMesh&&(s.type="BatchedMesh",s.perObjectFrustumCulled=this.perObjectFrustumCulled,s.sortObjects=this.sortObjects,s.drawRanges=this.ki,s.reservedRanges=this.zi,s.geometryInfo=this.k.map(a=>({...a,boundingBox:a.boundingBox?a.boundingBox.toJSON():void 0,boundingSphere:a.boundingSphere?a.boundingSphere.toJSON():void 0})),s.instanceInfo=this.L.map(a=>({...a})),s.availableInstanceIds=this.j.slice(),s.availableGeometryIds=this.ae.slice(),s.nextIndexStart=this.le,s.nextVertexStart=this.ce,s.geometryCount=this.te,s.maxInstanceCount=this.O,s.maxVertexCount=this.he,s.maxIndexCount=this.ue,s.geometryInitialized=this.de,s.matricesTexture=this.B.toJSON(e),s.indirectTexture=this.V.toJSON(e),this.T!==null&&(s.colorsTexture=this.T.toJSON(e)),this.boundingSphere!==null&&(s.boundingSphere=this.boundingSphere.toJSON()),this.boundingBox!==null&&(s.boundingBox=this.boundingBox.toJSON()));function r(a,l){return a[l.uuid]===void 0&&(a[l.uuid]=l.toJSON(e)),l.uuid}if(this.isScene)this.background&&(this.background.isColor?s.background=this.background.toJSON():this.background.isTexture&&(s.background=this.background.toJSON(e).uuid)),this.environment&&this.environment.isTexture&&this.environment.isRenderTargetTexture!==!0&&(s.environment=this.environment.toJSON(e).uuid);else if(this.isMesh||this.isLine||this.isPoints){s.geometry=r(e.geometries,this.geometry);let a=this.geometry.parameters;if(a!==void 0&&a.shapes!==void 0){let l=a.shapes;if(Array.isArray(l))for(let c=0,h=l.length;c<h;c++){let d=l[c];r(e.shapes,d)}else r(e.shapes,l)}}if(this.isSkinnedMesh&&(s.bindMode=this.bindMode,s.bindMatrix=this.bindMatrix.toArray(),this.skeleton!==void 0&&(r(e.skeletons,this.skeleton),s.skeleton=this.skeleton.uuid)),this.material!==void 0)if(Array.isArray(this.material)){let a=[];for(let l=0,c=this.material.length;l<c;l++)a.push(r(e.materials,this.material[l]));s.material=a}else s.material=r(e.materials,this.material);if(this.children.length>0){s.children=[];for(let a=0;a<this.children.length;a++)s.children.push(this.children[a].toJSON(e).object)}if(this.animations.length>0){s.animations=[];for(let a=0;a<this.animations.length;a++){let l=this.animations[a];s.animations.push(r(e.animations,l))}}if(t){let a=o(e.geometries),l=o(e.materials),c=o(e.textures),h=o(e.images),d=o(e.shapes),u=o(e.skeletons),f=o(e.animations),v=o(e.nodes);a.length>0&&(n.geometries=a),l.length>0&&(n.materials=l),c.length>0&&(n.textures=c),h.length>0&&(n.images=h),d.length>0&&(n.shapes=d),u.length>0&&(n.skeletons=u),f.length>0&&(n.animations=f),v.length>0&&(n.nodes=v)}return n.object=s,n;function o(a){let l=[];for(let c in a){let h=a[c];delete h.metadata,l.push(h)}return l}}clone(e){return new this.constructor().copy(this,e)}copy(e,t=!0){if(this.name=e.name,this.up.copy(e.up),this.position.copy(e.position),this.rotation.order=e.rotation.order,this.quaternion.copy(e.quaternion),this.scale.copy(e.scale),this.pivot=e.pivot!==null?e.pivot.clone():null,this.matrix.copy(e.matrix),this.matrixWorld.copy(e.matrixWorld),this.matrixAutoUpdate=e.matrixAutoUpdate,this.matrixWorldAutoUpdate=e.matrixWorldAutoUpdate,this.matrixWorldNeedsUpdate=e.matrixWorldNeedsUpdate,this.layers.mask=e.layers.mask,this.visible=e.visible,this.castShadow=e.castShadow,this.receiveShadow=e.receiveShadow,this.frustumCulled=e.frustumCulled,this.renderOrder=e.renderOrder,this.static=e.static,this.animations=e.animations.slice(),this.userData=JSON.parse(JSON.stringify(e.userData)),t===!0)for(let n=0;n<e.children.length;n++){let s=e.children[n];this.add(s.clone())}return this}dispose(){this.dispatchEvent({type:"dispose"})}};$t.DEFAULT_UP=new N(0,1,0);$t.DEFAULT_MATRIX_AUTO_UPDATE=!0;$t.DEFAULT_MATRIX_WORLD_AUTO_UPDATE=!0;var un=class extends $t{constructor(){super(),this.isGroup=!0,this.type="Group"}},Ff={type:"move"},ss=class{constructor(){this.H=null,this.G=null,this.Y=null}getHandSpace(){return this.Y===null&&(this.Y=new un,this.Y.matrixAutoUpdate=!1,this.Y.visible=!1,this.Y.joints={},this.Y.inputState={pinching:!1}),this.Y}getTargetRaySpace(){return this.H===null&&(this.H=new un,this.H.matrixAutoUpdate=!1,this.H.visible=!1,this.H.hasLinearVelocity=!1,this.H.linearVelocity=new N,this.H.hasAngularVelocity=!1,this.H.angularVelocity=new N),this.H}getGripSpace(){return this.G===null&&(this.G=new un,this.G.matrixAutoUpdate=!1,this.G.visible=!1,this.G.hasLinearVelocity=!1,this.G.linearVelocity=new N,this.G.hasAngularVelocity=!1,this.G.angularVelocity=new N,this.G.eventsEnabled=!1),this.G}dispatchEvent(e){return this.H!==null&&this.H.dispatchEvent(e),this.G!==null&&this.G.dispatchEvent(e),this.Y!==null&&this.Y.dispatchEvent(e),this}connect(e){if(e&&e.hand){let t=this.Y;if(t)for(let n of e.hand.values())this.Sn(t,n)}return this.dispatchEvent({type:"connected",data:e}),this}disconnect(e){return this.dispatchEvent({type:"disconnected",data:e}),this.H!==null&&(this.H.visible=!1),this.G!==null&&(this.G.visible=!1),this.Y!==null&&(this.Y.visible=!1),this}update(e,t,n){let s=null,r=null,o=null,a=this.H,l=this.G,c=this.Y;if(e&&t.session.visibilityState!=="visible-blurred"){if(c&&e.hand){o=!0;for(let S of e.hand.values()){let m=t.getJointPose(S,n),p=this.Sn(c,S);m!==null&&(p.matrix.fromArray(m.transform.matrix),p.matrix.decompose(p.position,p.quaternion,p.scale),p.matrixWorldNeedsUpdate=!0,p.jointRadius=m.radius),p.visible=m!==null}let h=c.joints["index-finger-tip"],d=c.joints["thumb-tip"],u=h.position.distanceTo(d.position),f=.02,v=.005;c.inputState.pinching&&u>f+v?(c.inputState.pinching=!1,this.dispatchEvent({type:"pinchend",handedness:e.handedness,target:this})):!c.inputState.pinching&&u<=f-v&&(c.inputState.pinching=!0,this.dispatchEvent({type:"pinchstart",handedness:e.handedness,target:this}))}else l!==null&&e.gripSpace&&(r=t.getPose(e.gripSpace,n),r!==null&&(l.matrix.fromArray(r.transform.matrix),l.matrix.decompose(l.position,l.quaternion,l.scale),l.matrixWorldNeedsUpdate=!0,r.linearVelocity?(l.hasLinearVelocity=!0,l.linearVelocity.copy(r.linearVelocity)):l.hasLinearVelocity=!1,r.angularVelocity?(l.hasAngularVelocity=!0,l.angularVelocity.copy(r.angularVelocity)):l.hasAngularVelocity=!1,l.eventsEnabled&&l.dispatchEvent({type:"gripUpdated",data:e,target:this})));a!==null&&(s=t.getPose(e.targetRaySpace,n),s===null&&r!==null&&(s=r),s!==null&&(a.matrix.fromArray(s.transform.matrix),a.matrix.decompose(a.position,a.quaternion,a.scale),a.matrixWorldNeedsUpdate=!0,s.linearVelocity?(a.hasLinearVelocity=!0,a.linearVelocity.copy(s.linearVelocity)):a.hasLinearVelocity=!1,s.angularVelocity?(a.hasAngularVelocity=!0,a.angularVelocity.copy(s.angularVelocity)):a.hasAngularVelocity=!1,this.dispatchEvent(Ff)))}return a!==null&&(a.visible=s!==null),l!==null&&(l.visible=r!==null),c!==null&&(c.visible=o!==null),this}Sn(e,t){if(e.joints[t.jointName]===void 0){let n=new un;n.matrixAutoUpdate=!1,n.visible=!1,e.joints[t.jointName]=n,e.add(n)}return e.joints[t.jointName]}},cu={aliceblue:15792383,antiquewhite:16444375,aqua:65535,aquamarine:8388564,azure:15794175,beige:16119260,bisque:16770244,black:0,blanchedalmond:16772045,blue:255,blueviolet:9055202,brown:10824234,burlywood:14596231,cadetblue:6266528,chartreuse:8388352,chocolate:13789470,coral:16744272,cornflowerblue:6591981,cornsilk:16775388,crimson:14423100,cyan:65535,darkblue:139,darkcyan:35723,darkgoldenrod:12092939,darkgray:11119017,darkgreen:25600,darkgrey:11119017,darkkhaki:12433259,darkmagenta:9109643,darkolivegreen:5597999,darkorange:16747520,darkorchid:10040012,darkred:9109504,darksalmon:15308410,darkseagreen:9419919,darkslateblue:4734347,darkslategray:3100495,darkslategrey:3100495,darkturquoise:52945,darkviolet:9699539,deeppink:16716947,deepskyblue:49151,dimgray:6908265,dimgrey:6908265,dodgerblue:2003199,firebrick:11674146,floralwhite:16775920,forestgreen:2263842,fuchsia:16711935,gainsboro:14474460,ghostwhite:16316671,gold:16766720,goldenrod:14329120,gray:8421504,green:32768,greenyellow:11403055,grey:8421504,honeydew:15794160,hotpink:16738740,indianred:13458524,indigo:4915330,ivory:16777200,khaki:15787660,lavender:15132410,lavenderblush:16773365,lawngreen:8190976,lemonchiffon:16775885,lightblue:11393254,lightcoral:15761536,lightcyan:14745599,lightgoldenrodyellow:16448210,lightgray:13882323,lightgreen:9498256,lightgrey:13882323,lightpink:16758465,lightsalmon:16752762,lightseagreen:2142890,lightskyblue:8900346,lightslategray:7833753,lightslategrey:7833753,lightsteelblue:11584734,lightyellow:16777184,lime:65280,limegreen:3329330,linen:16445670,magenta:16711935,maroon:8388608,mediumaquamarine:6737322,mediumblue:205,mediumorchid:12211667,mediumpurple:9662683,mediumseagreen:3978097,mediumslateblue:8087790,mediumspringgreen:64154,mediumturquoise:4772300,mediumvioletred:13047173,midnightblue:1644912,mintcream:16121850,mistyrose:16770273,moccasin:16770229,navajowhite:16768685,navy:128,oldlace:16643558,olive:8421376,olivedrab:7048739,orange:16753920,orangered:16729344,orchid:14315734,palegoldenrod:15657130,palegreen:10025880,paleturquoise:11529966,palevioletred:14381203,papayawhip:16773077,peachpuff:16767673,peru:13468991,pink:16761035,plum:14524637,powderblue:11591910,purple:8388736,rebeccapurple:6697881,red:16711680,rosybrown:12357519,royalblue:4286945,saddlebrown:9127187,salmon:16416882,sandybrown:16032864,seagreen:3050327,seashell:16774638,sienna:10506797,silver:12632256,skyblue:8900331,slateblue:6970061,slategray:7372944,slategrey:7372944,snow:16775930,springgreen:65407,steelblue:4620980,tan:13808780,teal:32896,thistle:14204888,tomato:16737095,turquoise:4251856,violet:15631086,wheat:16113331,white:16777215,whitesmoke:16119285,yellow:16776960,yellowgreen:10145074},si={h:0,s:0,l:0},br={h:0,s:0,l:0};function Xa(i,e,t){return t<0&&(t+=1),t>1&&(t-=1),t<1/6?i+(e-i)*6*t:t<1/2?e:t<2/3?i+(e-i)*6*(2/3-t):i}var Ze=class{constructor(e,t,n){return this.isColor=!0,this.r=1,this.g=1,this.b=1,this.set(e,t,n)}set(e,t,n){if(t===void 0&&n===void 0){let s=e;s&&s.isColor?this.copy(s):typeof s=="number"?this.setHex(s):typeof s=="string"&&this.setStyle(s)}else this.setRGB(e,t,n);return this}setScalar(e){return this.r=e,this.g=e,this.b=e,this}setHex(e,t=Kt){return e=Math.floor(e),this.r=(e>>16&255)/255,this.g=(e>>8&255)/255,this.b=(e&255)/255,Ye.colorSpaceToWorking(this,t),this}setRGB(e,t,n,s=Ye.workingColorSpace){return this.r=e,this.g=t,this.b=n,Ye.colorSpaceToWorking(this,s),this}setHSL(e,t,n,s=Ye.workingColorSpace){if(e=zl(e,1),t=He(t,0,1),n=He(n,0,1),t===0)this.r=this.g=this.b=n;else{let r=n<=.5?n*(1+t):n+t-n*t,o=2*n-r;this.r=Xa(o,r,e+1/3),this.g=Xa(o,r,e),this.b=Xa(o,r,e-1/3)}return Ye.colorSpaceToWorking(this,s),this}setStyle(e,t=Kt){function n(r){r!==void 0&&parseFloat(r)<1&&Ce("Color: Alpha component of "+e+" will be ignored.")}let s;if(s=/^(\w+)\(([^\)]*)\)/.exec(e)){let r,o=s[1],a=s[2];switch(o){case"rgb":case"rgba":if(r=/^\s*(\d+)\s*,\s*(\d+)\s*,\s*(\d+)\s*(?:,\s*(\d+(?:\.\d+)?|\.\d+)\s*)?$/.exec(a))return n(r[4]),this.setRGB(Math.min(255,parseInt(r[1],10))/255,Math.min(255,parseInt(r[2],10))/255,Math.min(255,parseInt(r[3],10))/255,t);if(r=/^\s*(\d+(?:\.\d+)?|\.\d+)\%\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*(?:,\s*(\d+(?:\.\d+)?|\.\d+)\s*)?$/.exec(a))return n(r[4]),this.setRGB(Math.min(100,parseFloat(r[1]))/100,Math.min(100,parseFloat(r[2]))/100,Math.min(100,parseFloat(r[3]))/100,t);break;case"hsl":case"hsla":if(r=/^\s*([+-]?(?:\d+(?:\.\d+)?|\.\d+))\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*(?:,\s*(\d+(?:\.\d+)?|\.\d+)\s*)?$/.exec(a))return n(r[4]),this.setHSL(parseFloat(r[1])/360,parseFloat(r[2])/100,parseFloat(r[3])/100,t);break;default:Ce("Color: Unknown color model "+e)}}else if(s=/^\#([A-Fa-f\d]+)$/.exec(e)){let r=s[1],o=r.length;if(o===3)return this.setRGB(parseInt(r.charAt(0),16)/15,parseInt(r.charAt(1),16)/15,parseInt(r.charAt(2),16)/15,t);if(o===6)return this.setHex(parseInt(r,16),t);Ce("Color: Invalid hex color "+e)}else if(e&&e.length>0)return this.setColorName(e,t);return this}setColorName(e,t=Kt){let n=cu[e.toLowerCase()];return n!==void 0?this.setHex(n,t):Ce("Color: Unknown color "+e),this}clone(){return new this.constructor(this.r,this.g,this.b)}copy(e){return this.r=e.r,this.g=e.g,this.b=e.b,this}copySRGBToLinear(e){return this.r=Gn(e.r),this.g=Gn(e.g),this.b=Gn(e.b),this}copyLinearToSRGB(e){return this.r=Qi(e.r),this.g=Qi(e.g),this.b=Qi(e.b),this}convertSRGBToLinear(){return this.copySRGBToLinear(this),this}convertLinearToSRGB(){return this.copyLinearToSRGB(this),this}getHex(e=Kt){return Ye.workingToColorSpace(Bt.copy(this),e),Math.round(He(Bt.r*255,0,255))*65536+Math.round(He(Bt.g*255,0,255))*256+Math.round(He(Bt.b*255,0,255))}getHexString(e=Kt){return("000000"+this.getHex(e).toString(16)).slice(-6)}getHSL(e,t=Ye.workingColorSpace){Ye.workingToColorSpace(Bt.copy(this),t);let n=Bt.r,s=Bt.g,r=Bt.b,o=Math.max(n,s,r),a=Math.min(n,s,r),l,c,h=(a+o)/2;if(a===o)l=0,c=0;else{let d=o-a;switch(c=h<=.5?d/(o+a):d/(2-o-a),o){case n:l=(s-r)/d+(s<r?6:0);break;case s:l=(r-n)/d+2;break;case r:l=(n-s)/d+4;break}l/=6}return e.h=l,e.s=c,e.l=h,e}getRGB(e,t=Ye.workingColorSpace){return Ye.workingToColorSpace(Bt.copy(this),t),e.r=Bt.r,e.g=Bt.g,e.b=Bt.b,e}getStyle(e=Kt){Ye.workingToColorSpace(Bt.copy(this),e);let t=Bt.r,n=Bt.g,s=Bt.b;return e!==Kt?`color(${e} ${t.toFixed(3)} ${n.toFixed(3)} ${s.toFixed(3)})`:`rgb(${Math.round(t*255)},${Math.round(n*255)},${Math.round(s*255)})`}offsetHSL(e,t,n){return this.getHSL(si),this.setHSL(si.h+e,si.s+t,si.l+n)}add(e){return this.r+=e.r,this.g+=e.g,this.b+=e.b,this}addColors(e,t){return this.r=e.r+t.r,this.g=e.g+t.g,this.b=e.b+t.b,this}addScalar(e){return this.r+=e,this.g+=e,this.b+=e,this}sub(e){return this.r=Math.max(0,this.r-e.r),this.g=Math.max(0,this.g-e.g),this.b=Math.max(0,this.b-e.b),this}multiply(e){return this.r*=e.r,this.g*=e.g,this.b*=e.b,this}multiplyScalar(e){return this.r*=e,this.g*=e,this.b*=e,this}lerp(e,t){return this.r+=(e.r-this.r)*t,this.g+=(e.g-this.g)*t,this.b+=(e.b-this.b)*t,this}lerpColors(e,t,n){return this.r=e.r+(t.r-e.r)*n,this.g=e.g+(t.g-e.g)*n,this.b=e.b+(t.b-e.b)*n,this}lerpHSL(e,t){this.getHSL(si),e.getHSL(br);let n=Cs(si.h,br.h,t),s=Cs(si.s,br.s,t),r=Cs(si.l,br.l,t);return this.setHSL(n,s,r),this}setFromVector3(e){return this.r=e.x,this.g=e.y,this.b=e.z,this}applyMatrix3(e){let t=this.r,n=this.g,s=this.b,r=e.elements;return this.r=r[0]*t+r[3]*n+r[6]*s,this.g=r[1]*t+r[4]*n+r[7]*s,this.b=r[2]*t+r[5]*n+r[8]*s,this}equals(e){return e.r===this.r&&e.g===this.g&&e.b===this.b}fromArray(e,t=0){return this.r=e[t],this.g=e[t+1],this.b=e[t+2],this}toArray(e=[],t=0){return e[t]=this.r,e[t+1]=this.g,e[t+2]=this.b,e}fromBufferAttribute(e,t){return this.r=e.getX(t),this.g=e.getY(t),this.b=e.getZ(t),this}toJSON(){return this.getHex()}*[Symbol.iterator](){yield this.r,yield this.g,yield this.b}},Bt=new Ze;Ze.NAMES=cu;var Fs=class extends $t{constructor(){super(),this.isScene=!0,this.type="Scene",this.background=null,this.environment=null,this.fog=null,this.backgroundBlurriness=0,this.backgroundIntensity=1,this.backgroundRotation=new ci,this.environmentIntensity=1,this.environmentRotation=new ci,this.overrideMaterial=null}copy(e,t){return super.copy(e,t),this.background=e.background!==null?e.background.clone():null,this.environment=e.environment!==null?e.environment.clone():null,this.fog=e.fog!==null?e.fog.clone():null,this.backgroundBlurriness=e.backgroundBlurriness,this.backgroundIntensity=e.backgroundIntensity,this.backgroundRotation.copy(e.backgroundRotation),this.environmentIntensity=e.environmentIntensity,this.environmentRotation.copy(e.environmentRotation),this.overrideMaterial=e.overrideMaterial!==null?e.overrideMaterial.clone():null,this.matrixAutoUpdate=e.matrixAutoUpdate,this}toJSON(e){let t=super.toJSON(e);return this.fog!==null&&(t.object.fog=this.fog.toJSON()),t.object.backgroundBlurriness=this.backgroundBlurriness,t.object.backgroundIntensity=this.backgroundIntensity,t.object.backgroundRotation=this.backgroundRotation.toArray(),t.object.environmentIntensity=this.environmentIntensity,t.object.environmentRotation=this.environmentRotation.toArray(),t}},gn=new N,Fn=new N,qa=new N,Bn=new N,Wi=new N,Xi=new N,lh=new N,Ya=new N,$a=new N,Za=new N,ja=new dt,Ja=new dt,Ka=new dt,li=class i{constructor(e=new N,t=new N,n=new N){this.a=e,this.b=t,this.c=n}static getNormal(e,t,n,s){s.subVectors(n,t),gn.subVectors(e,t),s.cross(gn);let r=s.lengthSq();return r>0?s.multiplyScalar(1/Math.sqrt(r)):s.set(0,0,0)}static getBarycoord(e,t,n,s,r){gn.subVectors(s,t),Fn.subVectors(n,t),qa.subVectors(e,t);let o=gn.dot(gn),a=gn.dot(Fn),l=gn.dot(qa),c=Fn.dot(Fn),h=Fn.dot(qa),d=o*c-a*a;if(d===0)return r.set(0,0,0),null;let u=1/d,f=(c*l-a*h)*u,v=(o*h-a*l)*u;return r.set(1-f-v,v,f)}static containsPoint(e,t,n,s){return this.getBarycoord(e,t,n,s,Bn)===null?!1:Bn.x>=0&&Bn.y>=0&&Bn.x+Bn.y<=1}static getInterpolation(e,t,n,s,r,o,a,l){return this.getBarycoord(e,t,n,s,Bn)===null?(l.x=0,l.y=0,"z"in l&&(l.z=0),"w"in l&&(l.w=0),null):(l.setScalar(0),l.addScaledVector(r,Bn.x),l.addScaledVector(o,Bn.y),l.addScaledVector(a,Bn.z),l)}static getInterpolatedAttribute(e,t,n,s,r,o){return ja.setScalar(0),Ja.setScalar(0),Ka.setScalar(0),ja.fromBufferAttribute(e,t),Ja.fromBufferAttribute(e,n),Ka.fromBufferAttribute(e,s),o.setScalar(0),o.addScaledVector(ja,r.x),o.addScaledVector(Ja,r.y),o.addScaledVector(Ka,r.z),o}static isFrontFacing(e,t,n,s){return gn.subVectors(n,t),Fn.subVectors(e,t),gn.cross(Fn).dot(s)<0}set(e,t,n){return this.a.copy(e),this.b.copy(t),this.c.copy(n),this}setFromPointsAndIndices(e,t,n,s){return this.a.copy(e[t]),this.b.copy(e[n]),this.c.copy(e[s]),this}setFromAttributeAndIndices(e,t,n,s){return this.a.fromBufferAttribute(e,t),this.b.fromBufferAttribute(e,n),this.c.fromBufferAttribute(e,s),this}clone(){return new this.constructor().copy(this)}copy(e){return this.a.copy(e.a),this.b.copy(e.b),this.c.copy(e.c),this}getArea(){return gn.subVectors(this.c,this.b),Fn.subVectors(this.a,this.b),gn.cross(Fn).length()*.5}getMidpoint(e){return e.addVectors(this.a,this.b).add(this.c).multiplyScalar(1/3)}getNormal(e){return i.getNormal(this.a,this.b,this.c,e)}getPlane(e){return e.setFromCoplanarPoints(this.a,this.b,this.c)}getBarycoord(e,t){return i.getBarycoord(e,this.a,this.b,this.c,t)}getInterpolation(e,t,n,s,r){return i.getInterpolation(e,this.a,this.b,this.c,t,n,s,r)}containsPoint(e){return i.containsPoint(e,this.a,this.b,this.c)}isFrontFacing(e){return i.isFrontFacing(this.a,this.b,this.c,e)}intersectsBox(e){return e.intersectsTriangle(this)}closestPointToPoint(e,t){let n=this.a,s=this.b,r=this.c,o,a;Wi.subVectors(s,n),Xi.subVectors(r,n),Ya.subVectors(e,n);let l=Wi.dot(Ya),c=Xi.dot(Ya);if(l<=0&&c<=0)return t.copy(n);$a.subVectors(e,s);let h=Wi.dot($a),d=Xi.dot($a);if(h>=0&&d<=h)return t.copy(s);let u=l*d-h*c;if(u<=0&&l>=0&&h<=0&&l-h>0)return o=l/(l-h),t.copy(n).addScaledVector(Wi,o);Za.subVectors(e,r);let f=Wi.dot(Za),v=Xi.dot(Za);if(v>=0&&f<=v)return t.copy(r);let S=f*c-l*v;if(S<=0&&c>=0&&v<=0)return a=c/(c-v),t.copy(n).addScaledVector(Xi,a);let m=h*v-f*d;if(m<=0&&d-h>=0&&f-v>=0)return lh.subVectors(r,s),a=(d-h)/(d-h+(f-v)),t.copy(s).addScaledVector(lh,a);let p=1/(m+S+u);return o=S*p,a=u*p,t.copy(n).addScaledVector(Wi,o).addScaledVector(Xi,a)}equals(e){return e.a.equals(this.a)&&e.b.equals(this.b)&&e.c.equals(this.c)}},hi=class{constructor(e=new N(1/0,1/0,1/0),t=new N(-1/0,-1/0,-1/0)){this.isBox3=!0,this.min=e,this.max=t}set(e,t){return this.min.copy(e),this.max.copy(t),this}setFromArray(e){this.makeEmpty();for(let t=0,n=e.length;t<n;t+=3)this.expandByPoint(vn.fromArray(e,t));return this}setFromBufferAttribute(e){this.makeEmpty();for(let t=0,n=e.count;t<n;t++)this.expandByPoint(vn.fromBufferAttribute(e,t));return this}setFromPoints(e){this.makeEmpty();for(let t=0,n=e.length;t<n;t++)this.expandByPoint(e[t]);return this}setFromCenterAndSize(e,t){let n=vn.copy(t).multiplyScalar(.5);return this.min.copy(e).sub(n),this.max.copy(e).add(n),this}setFromObject(e,t=!1){return this.makeEmpty(),this.expandByObject(e,t)}clone(){return new this.constructor().copy(this)}copy(e){return this.min.copy(e.min),this.max.copy(e.max),this}makeEmpty(){return this.min.x=this.min.y=this.min.z=1/0,this.max.x=this.max.y=this.max.z=-1/0,this}isEmpty(){return this.max.x<this.min.x||this.max.y<this.min.y||this.max.z<this.min.z}getCenter(e){return this.isEmpty()?e.set(0,0,0):e.addVectors(this.min,this.max).multiplyScalar(.5)}getSize(e){return this.isEmpty()?e.set(0,0,0):e.subVectors(this.max,this.min)}expandByPoint(e){return this.min.min(e),this.max.max(e),this}expandByVector(e){return this.min.sub(e),this.max.add(e),this}expandByScalar(e){return this.min.addScalar(-e),this.max.addScalar(e),this}expandByObject(e,t=!1){e.updateWorldMatrix(!1,!1);let n=e.geometry;if(n!==void 0){let r=n.getAttribute("position");if(t===!0&&r!==void 0&&e.isInstancedMesh!==!0&&e.isBatchedMesh!==!0)for(let o=0,a=r.count;o<a;o++)e.isMesh===!0?e.getVertexPosition(o,vn):vn.fromBufferAttribute(r,o),vn.applyMatrix4(e.matrixWorld),this.expandByPoint(vn);else e.boundingBox!==void 0?(e.boundingBox===null&&e.computeBoundingBox(),_r.copy(e.boundingBox)):(n.boundingBox===null&&n.computeBoundingBox(),_r.copy(n.boundingBox)),_r.applyMatrix4(e.matrixWorld),this.union(_r)}let s=e.children;for(let r=0,o=s.length;r<o;r++)this.expandByObject(s[r],t);return this}containsPoint(e){return e.x>=this.min.x&&e.x<=this.max.x&&e.y>=this.min.y&&e.y<=this.max.y&&e.z>=this.min.z&&e.z<=this.max.z}containsBox(e){return this.min.x<=e.min.x&&e.max.x<=this.max.x&&this.min.y<=e.min.y&&e.max.y<=this.max.y&&this.min.z<=e.min.z&&e.max.z<=this.max.z}getParameter(e,t){return t.set((e.x-this.min.x)/(this.max.x-this.min.x),(e.y-this.min.y)/(this.max.y-this.min.y),(e.z-this.min.z)/(this.max.z-this.min.z))}intersectsBox(e){return e.max.x>=this.min.x&&e.min.x<=this.max.x&&e.max.y>=this.min.y&&e.min.y<=this.max.y&&e.max.z>=this.min.z&&e.min.z<=this.max.z}intersectsSphere(e){return this.clampPoint(e.center,vn),vn.distanceToSquared(e.center)<=e.radius*e.radius}intersectsPlane(e){let t,n;return e.normal.x>0?(t=e.normal.x*this.min.x,n=e.normal.x*this.max.x):(t=e.normal.x*this.max.x,n=e.normal.x*this.min.x),e.normal.y>0?(t+=e.normal.y*this.min.y,n+=e.normal.y*this.max.y):(t+=e.normal.y*this.max.y,n+=e.normal.y*this.min.y),e.normal.z>0?(t+=e.normal.z*this.min.z,n+=e.normal.z*this.max.z):(t+=e.normal.z*this.max.z,n+=e.normal.z*this.min.z),t<=-e.constant&&n>=-e.constant}intersectsTriangle(e){if(this.isEmpty())return!1;this.getCenter(_s),wr.subVectors(this.max,_s),qi.subVectors(e.a,_s),Yi.subVectors(e.b,_s),$i.subVectors(e.c,_s),ri.subVectors(Yi,qi),oi.subVectors($i,Yi),Ai.subVectors(qi,$i);let t=[0,-ri.z,ri.y,0,-oi.z,oi.y,0,-Ai.z,Ai.y,ri.z,0,-ri.x,oi.z,0,-oi.x,Ai.z,0,-Ai.x,-ri.y,ri.x,0,-oi.y,oi.x,0,-Ai.y,Ai.x,0];return!Qa(t,qi,Yi,$i,wr)||(t=[1,0,0,0,1,0,0,0,1],!Qa(t,qi,Yi,$i,wr))?!1:(Er.crossVectors(ri,oi),t=[Er.x,Er.y,Er.z],Qa(t,qi,Yi,$i,wr))}clampPoint(e,t){return t.copy(e).clamp(this.min,this.max)}distanceToPoint(e){return this.clampPoint(e,vn).distanceTo(e)}getBoundingSphere(e){return this.isEmpty()?e.makeEmpty():(this.getCenter(e.center),e.radius=this.getSize(vn).length()*.5),e}intersect(e){return this.min.max(e.min),this.max.min(e.max),this.isEmpty()&&this.makeEmpty(),this}union(e){return this.min.min(e.min),this.max.max(e.max),this}applyMatrix4(e){return this.isEmpty()?this:(kn[0].set(this.min.x,this.min.y,this.min.z).applyMatrix4(e),kn[1].set(this.min.x,this.min.y,this.max.z).applyMatrix4(e),kn[2].set(this.min.x,this.max.y,this.min.z).applyMatrix4(e),kn[3].set(this.min.x,this.max.y,this.max.z).applyMatrix4(e),kn[4].set(this.max.x,this.min.y,this.min.z).applyMatrix4(e),kn[5].set(this.max.x,this.min.y,this.max.z).applyMatrix4(e),kn[6].set(this.max.x,this.max.y,this.min.z).applyMatrix4(e),kn[7].set(this.max.x,this.max.y,this.max.z).applyMatrix4(e),this.setFromPoints(kn),this)}translate(e){return this.min.add(e),this.max.add(e),this}equals(e){return e.min.equals(this.min)&&e.max.equals(this.max)}toJSON(){return{min:this.min.toArray(),max:this.max.toArray()}}fromJSON(e){return this.min.fromArray(e.min),this.max.fromArray(e.max),this}},kn=[new N,new N,new N,new N,new N,new N,new N,new N],vn=new N,_r=new hi,qi=new N,Yi=new N,$i=new N,ri=new N,oi=new N,Ai=new N,_s=new N,wr=new N,Er=new N,Ti=new N;function Qa(i,e,t,n,s){for(let r=0,o=i.length-3;r<=o;r+=3){Ti.fromArray(i,r);let a=s.x*Math.abs(Ti.x)+s.y*Math.abs(Ti.y)+s.z*Math.abs(Ti.z),l=e.dot(Ti),c=t.dot(Ti),h=n.dot(Ti);if(Math.max(-Math.max(l,c,h),Math.min(l,c,h))>a)return!1}return!0}var gt=new N,Ar=new De,Bf=0,ut=class extends xn{constructor(e,t,n=!1){if(super(),Array.isArray(e))throw new TypeError("THREE.BufferAttribute: array should be a Typed Array.");this.isBufferAttribute=!0,Object.defineProperty(this,"id",{value:Bf++}),this.name="",this.array=e,this.itemSize=t,this.count=e!==void 0?e.length/t:0,this.normalized=n,this.usage=nu,this.updateRanges=[],this.gpuType=Sn,this.version=0,this.xe=e!==void 0?Vl(e):void 0}onUploadCallback(){}set needsUpdate(e){e===!0&&this.version++}setUsage(e){return this.usage=e,this}addUpdateRange(e,t){this.updateRanges.push({start:e,count:t})}clearUpdateRanges(){this.updateRanges.length=0}copy(e){return this.name=e.name,this.array=new e.array.constructor(e.array),this.itemSize=e.itemSize,this.count=e.count,this.normalized=e.normalized,this.usage=e.usage,this.gpuType=e.gpuType,this.xe=e.xe,this}copyAt(e,t,n){e*=this.itemSize,n*=t.itemSize;for(let s=0,r=this.itemSize;s<r;s++)this.array[e+s]=t.array[n+s];return this}copyArray(e){return this.array.set(e),this}applyMatrix3(e){if(this.itemSize===2)for(let t=0,n=this.count;t<n;t++)Ar.fromBufferAttribute(this,t),Ar.applyMatrix3(e),this.setXY(t,Ar.x,Ar.y);else if(this.itemSize===3)for(let t=0,n=this.count;t<n;t++)gt.fromBufferAttribute(this,t),gt.applyMatrix3(e),this.setXYZ(t,gt.x,gt.y,gt.z);return this}applyMatrix4(e){for(let t=0,n=this.count;t<n;t++)gt.fromBufferAttribute(this,t),gt.applyMatrix4(e),this.setXYZ(t,gt.x,gt.y,gt.z);return this}applyNormalMatrix(e){for(let t=0,n=this.count;t<n;t++)gt.fromBufferAttribute(this,t),gt.applyNormalMatrix(e),this.setXYZ(t,gt.x,gt.y,gt.z);return this}transformDirection(e){for(let t=0,n=this.count;t<n;t++)gt.fromBufferAttribute(this,t),gt.transformDirection(e),this.setXYZ(t,gt.x,gt.y,gt.z);return this}set(e,t=0){return this.array.set(e,t),this}getComponent(e,t){let n=this.array[e*this.itemSize+t];return this.normalized&&(n=this.J(n)),n}setComponent(e,t,n){return this.normalized&&(n=this.E(n)),this.array[e*this.itemSize+t]=n,this}getX(e){let t=this.array[e*this.itemSize];return this.normalized&&(t=this.J(t)),t}setX(e,t){return this.normalized&&(t=this.E(t)),this.array[e*this.itemSize]=t,this}getY(e){let t=this.array[e*this.itemSize+1];return this.normalized&&(t=this.J(t)),t}setY(e,t){return this.normalized&&(t=this.E(t)),this.array[e*this.itemSize+1]=t,this}getZ(e){let t=this.array[e*this.itemSize+2];return this.normalized&&(t=this.J(t)),t}setZ(e,t){return this.normalized&&(t=this.E(t)),this.array[e*this.itemSize+2]=t,this}getW(e){let t=this.array[e*this.itemSize+3];return this.normalized&&(t=this.J(t)),t}setW(e,t){return this.normalized&&(t=this.E(t)),this.array[e*this.itemSize+3]=t,this}setXY(e,t,n){return e*=this.itemSize,this.normalized&&(t=this.E(t),n=this.E(n)),this.array[e+0]=t,this.array[e+1]=n,this}setXYZ(e,t,n,s){return e*=this.itemSize,this.normalized&&(t=this.E(t),n=this.E(n),s=this.E(s)),this.array[e+0]=t,this.array[e+1]=n,this.array[e+2]=s,this}setXYZW(e,t,n,s,r){return e*=this.itemSize,this.normalized&&(t=this.E(t),n=this.E(n),s=this.E(s),r=this.E(r)),this.array[e+0]=t,this.array[e+1]=n,this.array[e+2]=s,this.array[e+3]=r,this}onUpload(e){return this.onUploadCallback=e,this}clone(){return new this.constructor(this.array,this.itemSize).copy(this)}toJSON(){let e={itemSize:this.itemSize,type:this.array.constructor.name,array:Array.from(this.array),normalized:this.normalized};return e.name=this.name,e.usage=this.usage,e.gpuType=this.gpuType,e}dispose(){this.dispatchEvent({type:"dispose"})}J(e){let t=this.xe;return t!==void 0?Math.max(e/t,-1):au(e,this.array)}E(e){let t=this.xe;return t!==void 0?Math.round(e*t):lu(e,this.array)}};var Bs=class extends ut{constructor(e,t,n){super(new Uint16Array(e),t,n)}};var ks=class extends ut{constructor(e,t,n){super(new Uint32Array(e),t,n)}};var qt=class extends ut{constructor(e,t,n){super(new Float32Array(e),t,n)}},kf=new hi,ws=new N,el=new N,dn=class{constructor(e=new N,t=-1){this.isSphere=!0,this.center=e,this.radius=t}set(e,t){return this.center.copy(e),this.radius=t,this}setFromPoints(e,t){let n=this.center;t!==void 0?n.copy(t):kf.setFromPoints(e).getCenter(n);let s=0;for(let r=0,o=e.length;r<o;r++)s=Math.max(s,n.distanceToSquared(e[r]));return this.radius=Math.sqrt(s),this}copy(e){return this.center.copy(e.center),this.radius=e.radius,this}isEmpty(){return this.radius<0}makeEmpty(){return this.center.set(0,0,0),this.radius=-1,this}containsPoint(e){return e.distanceToSquared(this.center)<=this.radius*this.radius}distanceToPoint(e){return e.distanceTo(this.center)-this.radius}intersectsSphere(e){let t=this.radius+e.radius;return e.center.distanceToSquared(this.center)<=t*t}intersectsBox(e){return e.intersectsSphere(this)}intersectsPlane(e){return Math.abs(e.distanceToPoint(this.center))<=this.radius}clampPoint(e,t){let n=this.center.distanceToSquared(e);return t.copy(e),n>this.radius*this.radius&&(t.sub(this.center).normalize(),t.multiplyScalar(this.radius).add(this.center)),t}getBoundingBox(e){return this.isEmpty()?(e.makeEmpty(),e):(e.set(this.center,this.center),e.expandByScalar(this.radius),e)}applyMatrix4(e){return this.center.applyMatrix4(e),this.radius=this.radius*e.getMaxScaleOnAxis(),this}translate(e){return this.center.add(e),this}expandByPoint(e){if(this.isEmpty())return this.center.copy(e),this.radius=0,this;ws.subVectors(e,this.center);let t=ws.lengthSq();if(t>this.radius*this.radius){let n=Math.sqrt(t),s=(n-this.radius)*.5;this.center.addScaledVector(ws,s/n),this.radius+=s}return this}union(e){return e.isEmpty()?this:this.isEmpty()?(this.copy(e),this):(this.center.equals(e.center)===!0?this.radius=Math.max(this.radius,e.radius):(el.subVectors(e.center,this.center).setLength(e.radius),this.expandByPoint(ws.copy(e.center).add(el)),this.expandByPoint(ws.copy(e.center).sub(el))),this)}equals(e){return e.center.equals(this.center)&&e.radius===this.radius}clone(){return new this.constructor().copy(this)}toJSON(){return{radius:this.radius,center:this.center.toArray()}}fromJSON(e){return this.radius=e.radius,this.center.fromArray(e.center),this}},zf=0,cn=new lt,tl=new $t,Zi=new N,Jt=new hi,Es=new hi,At=new N,It=class i extends xn{constructor(){super(),this.isBufferGeometry=!0,Object.defineProperty(this,"id",{value:zf++}),this.uuid=fs(),this.name="",this.type="BufferGeometry",this.index=null,this.indirect=null,this.indirectOffset=0,this.attributes={},this.morphAttributes={},this.morphTargetsRelative=!1,this.groups=[],this.boundingBox=null,this.boundingSphere=null,this.drawRange={start:0,count:1/0},this.userData={},this.Pe=!1}getIndex(){return this.index}setIndex(e){return Array.isArray(e)?this.index=new(uf(e)?ks:Bs)(e,1):this.index=e,this}setIndirect(e,t=0){return this.indirect=e,this.indirectOffset=t,this}getIndirect(){return this.indirect}getAttribute(e){return this.attributes[e]}setAttribute(e,t){return this.attributes[e]=t,this}deleteAttribute(e){return delete this.attributes[e],this}hasAttribute(e){return this.attributes[e]!==void 0}addGroup(e,t,n=0){this.groups.push({start:e,count:t,materialIndex:n})}clearGroups(){this.groups=[]}setDrawRange(e,t){this.drawRange.start=e,this.drawRange.count=t}applyMatrix4(e){let t=this.attributes.position;t!==void 0&&(t.applyMatrix4(e),t.needsUpdate=!0);let n=this.attributes.normal;if(n!==void 0){let r=new Ue().getNormalMatrix(e);n.applyNormalMatrix(r),n.needsUpdate=!0}let s=this.attributes.tangent;return s!==void 0&&(s.transformDirection(e),s.needsUpdate=!0),this.boundingBox!==null&&this.computeBoundingBox(),this.boundingSphere!==null&&this.computeBoundingSphere(),this.Pe=!0,this}applyQuaternion(e){return cn.makeRotationFromQuaternion(e),this.applyMatrix4(cn),this}rotateX(e){return cn.makeRotationX(e),this.applyMatrix4(cn),this}rotateY(e){return cn.makeRotationY(e),this.applyMatrix4(cn),this}rotateZ(e){return cn.makeRotationZ(e),this.applyMatrix4(cn),this}translate(e,t,n){return cn.makeTranslation(e,t,n),this.applyMatrix4(cn),this}scale(e,t,n){return cn.makeScale(e,t,n),this.applyMatrix4(cn),this}lookAt(e){return tl.lookAt(e),tl.updateMatrix(),this.applyMatrix4(tl.matrix),this}center(){return this.computeBoundingBox(),this.boundingBox.getCenter(Zi).negate(),this.translate(Zi.x,Zi.y,Zi.z),this}setFromPoints(e){let t=this.getAttribute("position");if(t===void 0){let n=[];for(let s=0,r=e.length;s<r;s++){let o=e[s];n.push(o.x,o.y,o.z||0)}this.setAttribute("position",new qt(n,3))}else{let n=Math.min(e.length,t.count);for(let s=0;s<n;s++){let r=e[s];t.setXYZ(s,r.x,r.y,r.z||0)}e.length>t.count&&Ce("BufferGeometry: Buffer size too small for points data. Use .dispose() and create a new geometry."),t.needsUpdate=!0}return this}computeBoundingBox(){this.boundingBox===null&&(this.boundingBox=new hi);let e=this.attributes.position,t=this.morphAttributes.position;if(e&&e.isGLBufferAttribute){Ne("BufferGeometry.computeBoundingBox(): GLBufferAttribute requires a manual bounding box.",this),this.boundingBox.set(new N(-1/0,-1/0,-1/0),new N(1/0,1/0,1/0));return}if(e!==void 0){if(this.boundingBox.setFromBufferAttribute(e),t)for(let n=0,s=t.length;n<s;n++){let r=t[n];Jt.setFromBufferAttribute(r),this.morphTargetsRelative?(At.addVectors(this.boundingBox.min,Jt.min),this.boundingBox.expandByPoint(At),At.addVectors(this.boundingBox.max,Jt.max),this.boundingBox.expandByPoint(At)):(this.boundingBox.expandByPoint(Jt.min),this.boundingBox.expandByPoint(Jt.max))}}else this.boundingBox.makeEmpty();(isNaN(this.boundingBox.min.x)||isNaN(this.boundingBox.min.y)||isNaN(this.boundingBox.min.z))&&Ne('BufferGeometry.computeBoundingBox(): Computed min/max have NaN values. The "position" attribute is likely to have NaN values.',this)}computeBoundingSphere(){this.boundingSphere===null&&(this.boundingSphere=new dn);let e=this.attributes.position,t=this.morphAttributes.position;if(e&&e.isGLBufferAttribute){Ne("BufferGeometry.computeBoundingSphere(): GLBufferAttribute requires a manual bounding sphere.",this),this.boundingSphere.set(new N,1/0);return}if(e){let n=this.boundingSphere.center;if(Jt.setFromBufferAttribute(e),t)for(let r=0,o=t.length;r<o;r++){let a=t[r];Es.setFromBufferAttribute(a),this.morphTargetsRelative?(At.addVectors(Jt.min,Es.min),Jt.expandByPoint(At),At.addVectors(Jt.max,Es.max),Jt.expandByPoint(At)):(Jt.expandByPoint(Es.min),Jt.expandByPoint(Es.max))}Jt.getCenter(n);let s=0;for(let r=0,o=e.count;r<o;r++)At.fromBufferAttribute(e,r),s=Math.max(s,n.distanceToSquared(At));if(t)for(let r=0,o=t.length;r<o;r++){let a=t[r],l=this.morphTargetsRelative;for(let c=0,h=a.count;c<h;c++)At.fromBufferAttribute(a,c),l&&(Zi.fromBufferAttribute(e,c),At.add(Zi)),s=Math.max(s,n.distanceToSquared(At))}this.boundingSphere.radius=Math.sqrt(s),isNaN(this.boundingSphere.radius)&&Ne('BufferGeometry.computeBoundingSphere(): Computed radius is NaN. The "position" attribute is likely to have NaN values.',this)}}computeTangents(){let e=this.index,t=this.attributes;if(e===null||t.position===void 0||t.normal===void 0||t.uv===void 0){Ne("BufferGeometry: .computeTangents() failed. Missing required attributes (index, position, normal or uv)");return}let n=t.position,s=t.normal,r=t.uv,o=this.getAttribute("tangent");(o===void 0||o.count!==n.count)&&(o=new ut(new Float32Array(4*n.count),4),this.setAttribute("tangent",o));let a=[],l=[],c=new Uint8Array(n.count);for(let k=0;k<n.count;k++)a[k]=new N,l[k]=new N;let h=new N,d=new N,u=new N,f=new De,v=new De,S=new De,m=new N,p=new N;function _(k,L,D){c[k]=c[L]=c[D]=1,h.fromBufferAttribute(n,k),d.fromBufferAttribute(n,L),u.fromBufferAttribute(n,D),f.fromBufferAttribute(r,k),v.fromBufferAttribute(r,L),S.fromBufferAttribute(r,D),d.sub(h),u.sub(h),v.sub(f),S.sub(f);let G=1/(v.x*S.y-S.x*v.y);isFinite(G)&&(m.copy(d).multiplyScalar(S.y).addScaledVector(u,-v.y).multiplyScalar(G),p.copy(u).multiplyScalar(v.x).addScaledVector(d,-S.x).multiplyScalar(G),a[k].add(m),a[L].add(m),a[D].add(m),l[k].add(p),l[L].add(p),l[D].add(p))}let R=this.groups;R.length===0&&(R=[{start:0,count:e.count}]);for(let k=0,L=R.length;k<L;++k){let D=R[k],G=D.start,$=D.count;for(let P=G,q=G+$;P<q;P+=3)_(e.getX(P+0),e.getX(P+1),e.getX(P+2))}let w=new N,T=new N,E=new N,g=new N;function b(k){E.fromBufferAttribute(s,k),g.copy(E);let L=a[k];w.copy(L),w.sub(E.multiplyScalar(E.dot(L))).normalize(),T.crossVectors(g,L);let G=T.dot(l[k])<0?-1:1;o.setXYZW(k,w.x,w.y,w.z,G)}for(let k=0,L=n.count;k<L;++k)c[k]&&b(k);this.Pe=!0}computeVertexNormals(){let e=this.index,t=this.getAttribute("position");if(t!==void 0){let n=this.getAttribute("normal");if(n===void 0||n.count!==t.count)n=new ut(new Float32Array(t.count*3),3),this.setAttribute("normal",n);else for(let u=0,f=n.count;u<f;u++)n.setXYZ(u,0,0,0);let s=new N,r=new N,o=new N,a=new N,l=new N,c=new N,h=new N,d=new N;if(e)for(let u=0,f=e.count;u<f;u+=3){let v=e.getX(u+0),S=e.getX(u+1),m=e.getX(u+2);s.fromBufferAttribute(t,v),r.fromBufferAttribute(t,S),o.fromBufferAttribute(t,m),h.subVectors(o,r),d.subVectors(s,r),h.cross(d),a.fromBufferAttribute(n,v),l.fromBufferAttribute(n,S),c.fromBufferAttribute(n,m),a.add(h),l.add(h),c.add(h),n.setXYZ(v,a.x,a.y,a.z),n.setXYZ(S,l.x,l.y,l.z),n.setXYZ(m,c.x,c.y,c.z)}else for(let u=0,f=t.count;u<f;u+=3)s.fromBufferAttribute(t,u+0),r.fromBufferAttribute(t,u+1),o.fromBufferAttribute(t,u+2),h.subVectors(o,r),d.subVectors(s,r),h.cross(d),n.setXYZ(u+0,h.x,h.y,h.z),n.setXYZ(u+1,h.x,h.y,h.z),n.setXYZ(u+2,h.x,h.y,h.z);this.normalizeNormals(),n.needsUpdate=!0}}normalizeNormals(){let e=this.attributes.normal;for(let t=0,n=e.count;t<n;t++)At.fromBufferAttribute(e,t),At.normalize(),e.setXYZ(t,At.x,At.y,At.z)}toNonIndexed(){function e(a,l){let c=a.array,h=a.itemSize,d=a.normalized,u=new c.constructor(l.length*h),f=0,v=0;for(let S=0,m=l.length;S<m;S++){a.isInterleavedBufferAttribute?f=l[S]*a.data.stride+a.offset:f=l[S]*h;for(let p=0;p<h;p++)u[v++]=c[f++]}return new ut(u,h,d)}if(this.index===null)return Ce("BufferGeometry.toNonIndexed(): BufferGeometry is already non-indexed."),this;let t=new i,n=this.index.array,s=this.attributes;for(let a in s){let l=s[a],c=e(l,n);t.setAttribute(a,c)}let r=this.morphAttributes;for(let a in r){let l=[],c=r[a];for(let h=0,d=c.length;h<d;h++){let u=c[h],f=e(u,n);l.push(f)}t.morphAttributes[a]=l}t.morphTargetsRelative=this.morphTargetsRelative;let o=this.groups;for(let a=0,l=o.length;a<l;a++){let c=o[a];t.addGroup(c.start,c.count,c.materialIndex)}return t}toJSON(){let e={metadata:{version:4.7,type:"BufferGeometry",generator:"BufferGeometry.toJSON"}};if(e.uuid=this.uuid,e.type=this.parameters!==void 0&&this.Pe===!0?"BufferGeometry":this.type,e.name=this.name,Object.keys(this.userData).length>0&&(e.userData=this.userData),this.parameters!==void 0&&this.Pe!==!0){let l=this.parameters;for(let c in l)l[c]!==void 0&&(e[c]=l[c]);return e}e.data={attributes:{}};let t=this.index;t!==null&&(e.data.index={type:t.array.constructor.name,array:Array.prototype.slice.call(t.array)});let n=this.attributes;for(let l in n){let c=n[l];e.data.attributes[l]=c.toJSON(e.data)}let s={},r=!1;for(let l in this.morphAttributes){let c=this.morphAttributes[l],h=[];for(let d=0,u=c.length;d<u;d++){let f=c[d];h.push(f.toJSON(e.data))}h.length>0&&(s[l]=h,r=!0)}r&&(e.data.morphAttributes=s,e.data.morphTargetsRelative=this.morphTargetsRelative);let o=this.groups;o.length>0&&(e.data.groups=JSON.parse(JSON.stringify(o)));let a=this.boundingSphere;return a!==null&&(e.data.boundingSphere=a.toJSON()),e}clone(){return new this.constructor().copy(this)}copy(e){this.index=null,this.attributes={},this.morphAttributes={},this.groups=[],this.boundingBox=null,this.boundingSphere=null;let t={};this.name=e.name;let n=e.index;n!==null&&this.setIndex(n.clone());let s=e.attributes;for(let c in s){let h=s[c];this.setAttribute(c,h.clone(t))}let r=e.morphAttributes;for(let c in r){let h=[],d=r[c];for(let u=0,f=d.length;u<f;u++)h.push(d[u].clone(t));this.morphAttributes[c]=h}this.morphTargetsRelative=e.morphTargetsRelative;let o=e.groups;for(let c=0,h=o.length;c<h;c++){let d=o[c];this.addGroup(d.start,d.count,d.materialIndex)}let a=e.boundingBox;a!==null&&(this.boundingBox=a.clone());let l=e.boundingSphere;return l!==null&&(this.boundingSphere=l.clone()),this.drawRange.start=e.drawRange.start,this.drawRange.count=e.drawRange.count,this.userData=e.userData,this.Pe=e.Pe,this}dispose(){this.dispatchEvent({type:"dispose"})}};var nl=new N,Gf=new N,Vf=new Ue,Qt=class{constructor(e=new N(1,0,0),t=0){this.isPlane=!0,this.normal=e,this.constant=t}set(e,t){return this.normal.copy(e),this.constant=t,this}setComponents(e,t,n,s){return this.normal.set(e,t,n),this.constant=s,this}setFromNormalAndCoplanarPoint(e,t){return this.normal.copy(e),this.constant=-t.dot(this.normal),this}setFromCoplanarPoints(e,t,n){let s=nl.subVectors(n,t).cross(Gf.subVectors(e,t)).normalize();return this.setFromNormalAndCoplanarPoint(s,e),this}copy(e){return this.normal.copy(e.normal),this.constant=e.constant,this}normalize(){let e=1/this.normal.length();return this.normal.multiplyScalar(e),this.constant*=e,this}negate(){return this.constant*=-1,this.normal.negate(),this}distanceToPoint(e){return this.normal.dot(e)+this.constant}distanceToSphere(e){return this.distanceToPoint(e.center)-e.radius}projectPoint(e,t){return t.copy(e).addScaledVector(this.normal,-this.distanceToPoint(e))}intersectLine(e,t,n=!0){let s=e.delta(nl),r=this.normal.dot(s);if(r===0)return this.distanceToPoint(e.start)===0?t.copy(e.start):null;let o=-(e.start.dot(this.normal)+this.constant)/r;return n===!0&&(o<0||o>1)?null:t.copy(e.start).addScaledVector(s,o)}intersectsLine(e){let t=this.distanceToPoint(e.start),n=this.distanceToPoint(e.end);return t<0&&n>0||n<0&&t>0}intersectsBox(e){return e.intersectsPlane(this)}intersectsSphere(e){return e.intersectsPlane(this)}coplanarPoint(e){return e.copy(this.normal).multiplyScalar(-this.constant)}applyMatrix4(e,t){let n=t||Vf.getNormalMatrix(e),s=this.coplanarPoint(nl).applyMatrix4(e),r=this.normal.applyMatrix3(n).normalize();return this.constant=-s.dot(r),this}translate(e){return this.constant-=e.dot(this.normal),this}equals(e){return e.normal.equals(this.normal)&&e.constant===this.constant}clone(){return new this.constructor().copy(this)}toJSON(){return{normal:this.normal.toArray(),constant:this.constant}}fromJSON(e){return this.normal.fromArray(e.normal),this.constant=e.constant,this}},Hf=0,Hn=class extends xn{constructor(){super(),this.isMaterial=!0,Object.defineProperty(this,"id",{value:Hf++}),this.uuid=fs(),this.name="",this.type="Material",this.blending=hs,this.side=Rn,this.vertexColors=!1,this.opacity=1,this.transparent=!1,this.alphaHash=!1,this.blendSrc=vl,this.blendDst=xl,this.blendEquation=Li,this.blendSrcAlpha=null,this.blendDstAlpha=null,this.blendEquationAlpha=null,this.blendColor=new Ze(0,0,0),this.blendAlpha=0,this.depthFunc=es,this.depthTest=!0,this.depthWrite=!0,this.stencilWriteMask=255,this.stencilFunc=jh,this.stencilRef=0,this.stencilFuncMask=255,this.stencilFail=Xr,this.stencilZFail=Xr,this.stencilZPass=Xr,this.stencilWrite=!1,this.clippingPlanes=null,this.clipIntersection=!1,this.clipShadows=!1,this.shadowSide=null,this.colorWrite=!0,this.precision=null,this.polygonOffset=!1,this.polygonOffsetFactor=0,this.polygonOffsetUnits=0,this.dithering=!1,this.alphaToCoverage=!1,this.premultipliedAlpha=!1,this.forceSinglePass=!1,this.allowOverride=!0,this.visible=!0,this.toneMapped=!0,this.userData={},this.version=0,this.Ft=0}get alphaTest(){return this.Ft}set alphaTest(e){this.Ft>0!=e>0&&this.version++,this.Ft=e}onBeforeRender(){}onBeforeCompile(){}customProgramCacheKey(){return this.onBeforeCompile.toString()}setValues(e){if(e!==void 0)for(let t in e){let n=e[t];if(n===void 0){Ce(`Material: parameter '${t}' has value of undefined.`);continue}let s=this[t];if(s===void 0){Ce(`Material: '${t}' is not a property of THREE.${this.type}.`);continue}s&&s.isColor?s.set(n):s&&s.isVector2&&n&&n.isVector2||s&&s.isEuler&&n&&n.isEuler||s&&s.isVector3&&n&&n.isVector3?s.copy(n):this[t]=n}}toJSON(e){let t=e===void 0||typeof e=="string";t&&(e={textures:{},images:{}});let n={metadata:{version:4.7,type:"Material",generator:"Material.toJSON"}};n.uuid=this.uuid,n.type=this.type,n.blending=this.blending,n.side=this.side,n.shadowSide=this.shadowSide,n.vertexColors=this.vertexColors,n.opacity=this.opacity,n.transparent=this.transparent,n.blendSrc=this.blendSrc,n.blendDst=this.blendDst,n.blendEquation=this.blendEquation,n.blendSrcAlpha=this.blendSrcAlpha,n.blendDstAlpha=this.blendDstAlpha,n.blendEquationAlpha=this.blendEquationAlpha,n.blendColor=this.blendColor.getHex(),n.blendAlpha=this.blendAlpha,n.depthFunc=this.depthFunc,n.depthTest=this.depthTest,n.depthWrite=this.depthWrite,n.colorWrite=this.colorWrite,n.clipIntersection=this.clipIntersection,n.clipShadows=this.clipShadows,n.stencilWriteMask=this.stencilWriteMask,n.stencilFunc=this.stencilFunc,n.stencilRef=this.stencilRef,n.stencilFuncMask=this.stencilFuncMask,n.stencilFail=this.stencilFail,n.stencilZFail=this.stencilZFail,n.stencilZPass=this.stencilZPass,n.stencilWrite=this.stencilWrite,n.polygonOffset=this.polygonOffset,n.polygonOffsetFactor=this.polygonOffsetFactor,n.polygonOffsetUnits=this.polygonOffsetUnits,n.dithering=this.dithering,n.alphaTest=this.alphaTest,n.alphaHash=this.alphaHash,n.alphaToCoverage=this.alphaToCoverage,n.premultipliedAlpha=this.premultipliedAlpha,n.forceSinglePass=this.forceSinglePass,n.allowOverride=this.allowOverride,n.visible=this.visible,n.toneMapped=this.toneMapped,n.name=this.name,this.color&&this.color.isColor&&(n.color=this.color.getHex()),this.roughness!==void 0&&(n.roughness=this.roughness),this.metalness!==void 0&&(n.metalness=this.metalness),this.sheen!==void 0&&(n.sheen=this.sheen),this.sheenColor&&this.sheenColor.isColor&&(n.sheenColor=this.sheenColor.getHex()),this.sheenRoughness!==void 0&&(n.sheenRoughness=this.sheenRoughness),this.emissive&&this.emissive.isColor&&(n.emissive=this.emissive.getHex()),this.emissiveIntensity!==void 0&&(n.emissiveIntensity=this.emissiveIntensity),this.specular&&this.specular.isColor&&(n.specular=this.specular.getHex()),this.specularIntensity!==void 0&&(n.specularIntensity=this.specularIntensity),this.specularColor&&this.specularColor.isColor&&(n.specularColor=this.specularColor.getHex()),this.shininess!==void 0&&(n.shininess=this.shininess),this.clearcoat!==void 0&&(n.clearcoat=this.clearcoat),this.clearcoatRoughness!==void 0&&(n.clearcoatRoughness=this.clearcoatRoughness),this.diffuseRoughness!==void 0&&(n.diffuseRoughness=this.diffuseRoughness),this.diffuseRoughnessMap&&this.diffuseRoughnessMap.isTexture&&(n.diffuseRoughnessMap=this.diffuseRoughnessMap.toJSON(e).uuid),this.clearcoatMap&&this.clearcoatMap.isTexture&&(n.clearcoatMap=this.clearcoatMap.toJSON(e).uuid),this.clearcoatRoughnessMap&&this.clearcoatRoughnessMap.isTexture&&(n.clearcoatRoughnessMap=this.clearcoatRoughnessMap.toJSON(e).uuid),this.clearcoatNormalMap&&this.clearcoatNormalMap.isTexture&&(n.clearcoatNormalMap=this.clearcoatNormalMap.toJSON(e).uuid,n.clearcoatNormalScale=this.clearcoatNormalScale.toArray()),this.sheenColorMap&&this.sheenColorMap.isTexture&&(n.sheenColorMap=this.sheenColorMap.toJSON(e).uuid),this.sheenRoughnessMap&&this.sheenRoughnessMap.isTexture&&(n.sheenRoughnessMap=this.sheenRoughnessMap.toJSON(e).uuid),this.dispersion!==void 0&&(n.dispersion=this.dispersion),this.retroreflectivity!==void 0&&(n.retroreflectivity=this.retroreflectivity),this.iridescence!==void 0&&(n.iridescence=this.iridescence),this.iridescenceIOR!==void 0&&(n.iridescenceIOR=this.iridescenceIOR),this.iridescenceThicknessMinimum!==void 0&&(n.iridescenceThicknessMinimum=this.iridescenceThicknessMinimum),this.iridescenceThicknessMaximum!==void 0&&(n.iridescenceThicknessMaximum=this.iridescenceThicknessMaximum),this.iridescenceMap&&this.iridescenceMap.isTexture&&(n.iridescenceMap=this.iridescenceMap.toJSON(e).uuid),this.iridescenceThicknessMap&&this.iridescenceThicknessMap.isTexture&&(n.iridescenceThicknessMap=this.iridescenceThicknessMap.toJSON(e).uuid),this.anisotropy!==void 0&&(n.anisotropy=this.anisotropy),this.anisotropyRotation!==void 0&&(n.anisotropyRotation=this.anisotropyRotation),this.anisotropyMap&&this.anisotropyMap.isTexture&&(n.anisotropyMap=this.anisotropyMap.toJSON(e).uuid),this.map&&this.map.isTexture&&(n.map=this.map.toJSON(e).uuid),this.matcap&&this.matcap.isTexture&&(n.matcap=this.matcap.toJSON(e).uuid),this.alphaMap&&this.alphaMap.isTexture&&(n.alphaMap=this.alphaMap.toJSON(e).uuid),this.lightMap&&this.lightMap.isTexture&&(n.lightMap=this.lightMap.toJSON(e).uuid,n.lightMapIntensity=this.lightMapIntensity),this.aoMap&&this.aoMap.isTexture&&(n.aoMap=this.aoMap.toJSON(e).uuid,n.aoMapIntensity=this.aoMapIntensity),this.bumpMap&&this.bumpMap.isTexture&&(n.bumpMap=this.bumpMap.toJSON(e).uuid,n.bumpScale=this.bumpScale),this.normalMap&&this.normalMap.isTexture&&(n.normalMap=this.normalMap.toJSON(e).uuid,n.normalMapType=this.normalMapType,n.normalScale=this.normalScale.toArray()),this.displacementMap&&this.displacementMap.isTexture&&(n.displacementMap=this.displacementMap.toJSON(e).uuid,n.displacementScale=this.displacementScale,n.displacementBias=this.displacementBias),this.roughnessMap&&this.roughnessMap.isTexture&&(n.roughnessMap=this.roughnessMap.toJSON(e).uuid),this.metalnessMap&&this.metalnessMap.isTexture&&(n.metalnessMap=this.metalnessMap.toJSON(e).uuid),this.emissiveMap&&this.emissiveMap.isTexture&&(n.emissiveMap=this.emissiveMap.toJSON(e).uuid),this.specularMap&&this.specularMap.isTexture&&(n.specularMap=this.specularMap.toJSON(e).uuid),this.specularIntensityMap&&this.specularIntensityMap.isTexture&&(n.specularIntensityMap=this.specularIntensityMap.toJSON(e).uuid),this.specularColorMap&&this.specularColorMap.isTexture&&(n.specularColorMap=this.specularColorMap.toJSON(e).uuid),this.envMap&&this.envMap.isTexture&&(n.envMap=this.envMap.toJSON(e).uuid,this.combine!==void 0&&(n.combine=this.combine)),this.envMapRotation!==void 0&&(n.envMapRotation=this.envMapRotation.toArray()),this.envMapIntensity!==void 0&&(n.envMapIntensity=this.envMapIntensity),this.reflectivity!==void 0&&(n.reflectivity=this.reflectivity),this.refractionRatio!==void 0&&(n.refractionRatio=this.refractionRatio),this.gradientMap&&this.gradientMap.isTexture&&(n.gradientMap=this.gradientMap.toJSON(e).uuid),this.transmission!==void 0&&(n.transmission=this.transmission),this.transmissionMap&&this.transmissionMap.isTexture&&(n.transmissionMap=this.transmissionMap.toJSON(e).uuid),this.thickness!==void 0&&(n.thickness=this.thickness),this.thicknessMap&&this.thicknessMap.isTexture&&(n.thicknessMap=this.thicknessMap.toJSON(e).uuid),this.attenuationDistance!==void 0&&(n.attenuationDistance=this.attenuationDistance),this.attenuationColor!==void 0&&(n.attenuationColor=this.attenuationColor.getHex()),this.size!==void 0&&(n.size=this.size),this.sizeAttenuation!==void 0&&(n.sizeAttenuation=this.sizeAttenuation),Array.isArray(this.clippingPlanes)&&this.clippingPlanes.length>0&&(n.clippingPlanes=this.clippingPlanes.map(r=>r.toJSON())),this.rotation!==void 0&&(n.rotation=this.rotation),this.depthPacking!==void 0&&(n.depthPacking=this.depthPacking),this.linewidth!==void 0&&(n.linewidth=this.linewidth),this.linecap!==void 0&&(n.linecap=this.linecap),this.linejoin!==void 0&&(n.linejoin=this.linejoin),this.dashSize!==void 0&&(n.dashSize=this.dashSize),this.gapSize!==void 0&&(n.gapSize=this.gapSize),this.scale!==void 0&&(n.scale=this.scale),this.wireframe!==void 0&&(n.wireframe=this.wireframe),this.wireframeLinewidth!==void 0&&(n.wireframeLinewidth=this.wireframeLinewidth),this.wireframeLinecap!==void 0&&(n.wireframeLinecap=this.wireframeLinecap),this.wireframeLinejoin!==void 0&&(n.wireframeLinejoin=this.wireframeLinejoin),this.flatShading!==void 0&&(n.flatShading=this.flatShading),this.fog!==void 0&&(n.fog=this.fog),Object.keys(this.userData).length>0&&(n.userData=this.userData);function s(r){let o=[];for(let a in r){let l=r[a];delete l.metadata,o.push(l)}return o}if(t){let r=s(e.textures),o=s(e.images);r.length>0&&(n.textures=r),o.length>0&&(n.images=o)}return n}fromJSON(e,t){if(e.uuid!==void 0&&(this.uuid=e.uuid),e.name!==void 0&&(this.name=e.name),e.color!==void 0&&this.color!==void 0&&this.color.setHex(e.color),e.roughness!==void 0&&(this.roughness=e.roughness),e.metalness!==void 0&&(this.metalness=e.metalness),e.sheen!==void 0&&(this.sheen=e.sheen),e.sheenColor!==void 0&&(this.sheenColor=new Ze().setHex(e.sheenColor)),e.sheenRoughness!==void 0&&(this.sheenRoughness=e.sheenRoughness),e.emissive!==void 0&&this.emissive!==void 0&&this.emissive.setHex(e.emissive),e.specular!==void 0&&this.specular!==void 0&&this.specular.setHex(e.specular),e.specularIntensity!==void 0&&(this.specularIntensity=e.specularIntensity),e.specularColor!==void 0&&this.specularColor!==void 0&&this.specularColor.setHex(e.specularColor),e.shininess!==void 0&&(this.shininess=e.shininess),e.clearcoat!==void 0&&(this.clearcoat=e.clearcoat),e.clearcoatRoughness!==void 0&&(this.clearcoatRoughness=e.clearcoatRoughness),e.diffuseRoughness!==void 0&&(this.diffuseRoughness=e.diffuseRoughness),e.dispersion!==void 0&&(this.dispersion=e.dispersion),e.retroreflectivity!==void 0&&(this.retroreflectivity=e.retroreflectivity),e.iridescence!==void 0&&(this.iridescence=e.iridescence),e.iridescenceIOR!==void 0&&(this.iridescenceIOR=e.iridescenceIOR),e.iridescenceThicknessMinimum!==void 0&&(this.iridescenceThicknessMinimum=e.iridescenceThicknessMinimum),e.iridescenceThicknessMaximum!==void 0&&(this.iridescenceThicknessMaximum=e.iridescenceThicknessMaximum),e.iridescenceThicknessRange!==void 0&&(this.iridescenceThicknessMinimum=e.iridescenceThicknessRange[0],this.iridescenceThicknessMaximum=e.iridescenceThicknessRange[1]),e.transmission!==void 0&&(this.transmission=e.transmission),e.thickness!==void 0&&(this.thickness=e.thickness),e.attenuationDistance!==void 0&&(this.attenuationDistance=e.attenuationDistance),e.attenuationColor!==void 0&&this.attenuationColor!==void 0&&this.attenuationColor.setHex(e.attenuationColor),e.anisotropy!==void 0&&(this.anisotropy=e.anisotropy),e.anisotropyRotation!==void 0&&(this.anisotropyRotation=e.anisotropyRotation),e.fog!==void 0&&(this.fog=e.fog),e.flatShading!==void 0&&(this.flatShading=e.flatShading),e.blending!==void 0&&(this.blending=e.blending),e.combine!==void 0&&(this.combine=e.combine),e.side!==void 0&&(this.side=e.side),e.shadowSide!==void 0&&(this.shadowSide=e.shadowSide),e.opacity!==void 0&&(this.opacity=e.opacity),e.transparent!==void 0&&(this.transparent=e.transparent),e.alphaTest!==void 0&&(this.alphaTest=e.alphaTest),e.alphaHash!==void 0&&(this.alphaHash=e.alphaHash),e.depthFunc!==void 0&&(this.depthFunc=e.depthFunc),e.depthTest!==void 0&&(this.depthTest=e.depthTest),e.depthWrite!==void 0&&(this.depthWrite=e.depthWrite),e.colorWrite!==void 0&&(this.colorWrite=e.colorWrite),e.clippingPlanes!==void 0&&(this.clippingPlanes=e.clippingPlanes.map(n=>new Qt().fromJSON(n))),e.clipIntersection!==void 0&&(this.clipIntersection=e.clipIntersection),e.clipShadows!==void 0&&(this.clipShadows=e.clipShadows),e.depthPacking!==void 0&&(this.depthPacking=e.depthPacking),e.blendSrc!==void 0&&(this.blendSrc=e.blendSrc),e.blendDst!==void 0&&(this.blendDst=e.blendDst),e.blendEquation!==void 0&&(this.blendEquation=e.blendEquation),e.blendSrcAlpha!==void 0&&(this.blendSrcAlpha=e.blendSrcAlpha),e.blendDstAlpha!==void 0&&(this.blendDstAlpha=e.blendDstAlpha),e.blendEquationAlpha!==void 0&&(this.blendEquationAlpha=e.blendEquationAlpha),e.blendColor!==void 0&&this.blendColor!==void 0&&this.blendColor.setHex(e.blendColor),e.blendAlpha!==void 0&&(this.blendAlpha=e.blendAlpha),e.stencilWriteMask!==void 0&&(this.stencilWriteMask=e.stencilWriteMask),e.stencilFunc!==void 0&&(this.stencilFunc=e.stencilFunc),e.stencilRef!==void 0&&(this.stencilRef=e.stencilRef),e.stencilFuncMask!==void 0&&(this.stencilFuncMask=e.stencilFuncMask),e.stencilFail!==void 0&&(this.stencilFail=e.stencilFail),e.stencilZFail!==void 0&&(this.stencilZFail=e.stencilZFail),e.stencilZPass!==void 0&&(this.stencilZPass=e.stencilZPass),e.stencilWrite!==void 0&&(this.stencilWrite=e.stencilWrite),e.wireframe!==void 0&&(this.wireframe=e.wireframe),e.wireframeLinewidth!==void 0&&(this.wireframeLinewidth=e.wireframeLinewidth),e.wireframeLinecap!==void 0&&(this.wireframeLinecap=e.wireframeLinecap),e.wireframeLinejoin!==void 0&&(this.wireframeLinejoin=e.wireframeLinejoin),e.rotation!==void 0&&(this.rotation=e.rotation),e.linewidth!==void 0&&(this.linewidth=e.linewidth),e.linecap!==void 0&&(this.linecap=e.linecap),e.linejoin!==void 0&&(this.linejoin=e.linejoin),e.dashSize!==void 0&&(this.dashSize=e.dashSize),e.gapSize!==void 0&&(this.gapSize=e.gapSize),e.scale!==void 0&&(this.scale=e.scale),e.polygonOffset!==void 0&&(this.polygonOffset=e.polygonOffset),e.polygonOffsetFactor!==void 0&&(this.polygonOffsetFactor=e.polygonOffsetFactor),e.polygonOffsetUnits!==void 0&&(this.polygonOffsetUnits=e.polygonOffsetUnits),e.dithering!==void 0&&(this.dithering=e.dithering),e.alphaToCoverage!==void 0&&(this.alphaToCoverage=e.alphaToCoverage),e.premultipliedAlpha!==void 0&&(this.premultipliedAlpha=e.premultipliedAlpha),e.forceSinglePass!==void 0&&(this.forceSinglePass=e.forceSinglePass),e.allowOverride!==void 0&&(this.allowOverride=e.allowOverride),e.visible!==void 0&&(this.visible=e.visible),e.toneMapped!==void 0&&(this.toneMapped=e.toneMapped),e.userData!==void 0&&(this.userData=e.userData),e.vertexColors!==void 0&&(typeof e.vertexColors=="number"?this.vertexColors=e.vertexColors>0:this.vertexColors=e.vertexColors),e.size!==void 0&&(this.size=e.size),e.sizeAttenuation!==void 0&&(this.sizeAttenuation=e.sizeAttenuation),e.map!==void 0&&(this.map=t[e.map]||null),e.matcap!==void 0&&(this.matcap=t[e.matcap]||null),e.alphaMap!==void 0&&(this.alphaMap=t[e.alphaMap]||null),e.bumpMap!==void 0&&(this.bumpMap=t[e.bumpMap]||null),e.bumpScale!==void 0&&(this.bumpScale=e.bumpScale),e.normalMap!==void 0&&(this.normalMap=t[e.normalMap]||null),e.normalMapType!==void 0&&(this.normalMapType=e.normalMapType),e.normalScale!==void 0){let n=e.normalScale;Array.isArray(n)===!1&&(n=[n,n]),this.normalScale=new De().fromArray(n)}return e.displacementMap!==void 0&&(this.displacementMap=t[e.displacementMap]||null),e.displacementScale!==void 0&&(this.displacementScale=e.displacementScale),e.displacementBias!==void 0&&(this.displacementBias=e.displacementBias),e.roughnessMap!==void 0&&(this.roughnessMap=t[e.roughnessMap]||null),e.metalnessMap!==void 0&&(this.metalnessMap=t[e.metalnessMap]||null),e.emissiveMap!==void 0&&(this.emissiveMap=t[e.emissiveMap]||null),e.emissiveIntensity!==void 0&&(this.emissiveIntensity=e.emissiveIntensity),e.specularMap!==void 0&&(this.specularMap=t[e.specularMap]||null),e.specularIntensityMap!==void 0&&(this.specularIntensityMap=t[e.specularIntensityMap]||null),e.specularColorMap!==void 0&&(this.specularColorMap=t[e.specularColorMap]||null),e.envMap!==void 0&&(this.envMap=t[e.envMap]||null),e.envMapRotation!==void 0&&this.envMapRotation.fromArray(e.envMapRotation),e.envMapIntensity!==void 0&&(this.envMapIntensity=e.envMapIntensity),e.reflectivity!==void 0&&(this.reflectivity=e.reflectivity),e.refractionRatio!==void 0&&(this.refractionRatio=e.refractionRatio),e.lightMap!==void 0&&(this.lightMap=t[e.lightMap]||null),e.lightMapIntensity!==void 0&&(this.lightMapIntensity=e.lightMapIntensity),e.aoMap!==void 0&&(this.aoMap=t[e.aoMap]||null),e.aoMapIntensity!==void 0&&(this.aoMapIntensity=e.aoMapIntensity),e.gradientMap!==void 0&&(this.gradientMap=t[e.gradientMap]||null),e.clearcoatMap!==void 0&&(this.clearcoatMap=t[e.clearcoatMap]||null),e.clearcoatRoughnessMap!==void 0&&(this.clearcoatRoughnessMap=t[e.clearcoatRoughnessMap]||null),e.clearcoatNormalMap!==void 0&&(this.clearcoatNormalMap=t[e.clearcoatNormalMap]||null),e.clearcoatNormalScale!==void 0&&(this.clearcoatNormalScale=new De().fromArray(e.clearcoatNormalScale)),e.diffuseRoughnessMap!==void 0&&(this.diffuseRoughnessMap=t[e.diffuseRoughnessMap]||null),e.iridescenceMap!==void 0&&(this.iridescenceMap=t[e.iridescenceMap]||null),e.iridescenceThicknessMap!==void 0&&(this.iridescenceThicknessMap=t[e.iridescenceThicknessMap]||null),e.transmissionMap!==void 0&&(this.transmissionMap=t[e.transmissionMap]||null),e.thicknessMap!==void 0&&(this.thicknessMap=t[e.thicknessMap]||null),e.anisotropyMap!==void 0&&(this.anisotropyMap=t[e.anisotropyMap]||null),e.sheenColorMap!==void 0&&(this.sheenColorMap=t[e.sheenColorMap]||null),e.sheenRoughnessMap!==void 0&&(this.sheenRoughnessMap=t[e.sheenRoughnessMap]||null),this}clone(){return new this.constructor().copy(this)}copy(e){this.name=e.name,this.blending=e.blending,this.side=e.side,this.vertexColors=e.vertexColors,this.opacity=e.opacity,this.transparent=e.transparent,this.blendSrc=e.blendSrc,this.blendDst=e.blendDst,this.blendEquation=e.blendEquation,this.blendSrcAlpha=e.blendSrcAlpha,this.blendDstAlpha=e.blendDstAlpha,this.blendEquationAlpha=e.blendEquationAlpha,this.blendColor.copy(e.blendColor),this.blendAlpha=e.blendAlpha,this.depthFunc=e.depthFunc,this.depthTest=e.depthTest,this.depthWrite=e.depthWrite,this.stencilWriteMask=e.stencilWriteMask,this.stencilFunc=e.stencilFunc,this.stencilRef=e.stencilRef,this.stencilFuncMask=e.stencilFuncMask,this.stencilFail=e.stencilFail,this.stencilZFail=e.stencilZFail,this.stencilZPass=e.stencilZPass,this.stencilWrite=e.stencilWrite;let t=e.clippingPlanes,n=null;if(t!==null){let s=t.length;n=new Array(s);for(let r=0;r!==s;++r)n[r]=t[r].clone()}return this.clippingPlanes=n,this.clipIntersection=e.clipIntersection,this.clipShadows=e.clipShadows,this.shadowSide=e.shadowSide,this.colorWrite=e.colorWrite,this.precision=e.precision,this.polygonOffset=e.polygonOffset,this.polygonOffsetFactor=e.polygonOffsetFactor,this.polygonOffsetUnits=e.polygonOffsetUnits,this.dithering=e.dithering,this.alphaTest=e.alphaTest,this.alphaHash=e.alphaHash,this.alphaToCoverage=e.alphaToCoverage,this.premultipliedAlpha=e.premultipliedAlpha,this.forceSinglePass=e.forceSinglePass,this.allowOverride=e.allowOverride,this.visible=e.visible,this.toneMapped=e.toneMapped,this.userData=JSON.parse(JSON.stringify(e.userData)),this}dispose(){this.dispatchEvent({type:"dispose"})}set needsUpdate(e){e===!0&&this.version++}};var zn=new N,il=new N,Tr=new N,Rr=new N,ui=class{constructor(e=new N,t=new N(0,0,-1)){this.origin=e,this.direction=t}set(e,t){return this.origin.copy(e),this.direction.copy(t),this}copy(e){return this.origin.copy(e.origin),this.direction.copy(e.direction),this}at(e,t){return t.copy(this.origin).addScaledVector(this.direction,e)}lookAt(e){return this.direction.copy(e).sub(this.origin).normalize(),this}recast(e){return this.origin.copy(this.at(e,zn)),this}closestPointToPoint(e,t){t.subVectors(e,this.origin);let n=t.dot(this.direction);return n<0?t.copy(this.origin):t.copy(this.origin).addScaledVector(this.direction,n)}distanceToPoint(e){return Math.sqrt(this.distanceSqToPoint(e))}distanceSqToPoint(e){let t=zn.subVectors(e,this.origin).dot(this.direction);return t<0?this.origin.distanceToSquared(e):(zn.copy(this.origin).addScaledVector(this.direction,t),zn.distanceToSquared(e))}distanceSqToSegment(e,t,n,s){il.copy(e).add(t).multiplyScalar(.5),Tr.copy(t).sub(e).normalize(),Rr.copy(this.origin).sub(il);let r=e.distanceTo(t)*.5,o=-this.direction.dot(Tr),a=Rr.dot(this.direction),l=-Rr.dot(Tr),c=Rr.lengthSq(),h=Math.abs(1-o*o),d,u,f,v;if(h>0)if(d=o*l-a,u=o*a-l,v=r*h,d>=0)if(u>=-v)if(u<=v){let S=1/h;d*=S,u*=S,f=d*(d+o*u+2*a)+u*(o*d+u+2*l)+c}else u=r,d=Math.max(0,-(o*u+a)),f=-d*d+u*(u+2*l)+c;else u=-r,d=Math.max(0,-(o*u+a)),f=-d*d+u*(u+2*l)+c;else u<=-v?(d=Math.max(0,-(-o*r+a)),u=d>0?-r:Math.min(Math.max(-r,-l),r),f=-d*d+u*(u+2*l)+c):u<=v?(d=0,u=Math.min(Math.max(-r,-l),r),f=u*(u+2*l)+c):(d=Math.max(0,-(o*r+a)),u=d>0?r:Math.min(Math.max(-r,-l),r),f=-d*d+u*(u+2*l)+c);else u=o>0?-r:r,d=Math.max(0,-(o*u+a)),f=-d*d+u*(u+2*l)+c;return n&&n.copy(this.origin).addScaledVector(this.direction,d),s&&s.copy(il).addScaledVector(Tr,u),f}intersectSphere(e,t){if(e.radius<0)return null;zn.subVectors(e.center,this.origin);let n=zn.dot(this.direction),s=zn.dot(zn)-n*n,r=e.radius*e.radius;if(s>r)return null;let o=Math.sqrt(r-s),a=n-o,l=n+o;return l<0?null:a<0?this.at(l,t):this.at(a,t)}intersectsSphere(e){return e.radius<0?!1:this.distanceSqToPoint(e.center)<=e.radius*e.radius}distanceToPlane(e){let t=e.normal.dot(this.direction);if(t===0)return e.distanceToPoint(this.origin)===0?0:null;let n=-(this.origin.dot(e.normal)+e.constant)/t;return n>=0?n:null}intersectPlane(e,t){let n=this.distanceToPlane(e);return n===null?null:this.at(n,t)}intersectsPlane(e){let t=e.distanceToPoint(this.origin);return t===0||e.normal.dot(this.direction)*t<0}intersectBox(e,t){let n,s,r,o,a,l,c=1/this.direction.x,h=1/this.direction.y,d=1/this.direction.z,u=this.origin;return c>=0?(n=(e.min.x-u.x)*c,s=(e.max.x-u.x)*c):(n=(e.max.x-u.x)*c,s=(e.min.x-u.x)*c),h>=0?(r=(e.min.y-u.y)*h,o=(e.max.y-u.y)*h):(r=(e.max.y-u.y)*h,o=(e.min.y-u.y)*h),n>o||r>s||((r>n||isNaN(n))&&(n=r),(o<s||isNaN(s))&&(s=o),d>=0?(a=(e.min.z-u.z)*d,l=(e.max.z-u.z)*d):(a=(e.max.z-u.z)*d,l=(e.min.z-u.z)*d),n>l||a>s)||((a>n||n!==n)&&(n=a),(l<s||s!==s)&&(s=l),s<0)?null:this.at(n>=0?n:s,t)}intersectsBox(e){return this.intersectBox(e,zn)!==null}intersectTriangle(e,t,n,s,r){let o=this.origin,a=this.direction,l=a.x,c=a.y,h=a.z,d=e.x-o.x,u=e.y-o.y,f=e.z-o.z,v=t.x-o.x,S=t.y-o.y,m=t.z-o.z,p=n.x-o.x,_=n.y-o.y,R=n.z-o.z,w=Math.abs(l),T=Math.abs(c),E=Math.abs(h),g,b,k,L,D,G,$,P,q,K,V,re;if(w>=T&&w>=E?(k=l,G=d,q=v,re=p,l>=0?(g=c,b=h,L=u,D=f,$=S,P=m,K=_,V=R):(g=h,b=c,L=f,D=u,$=m,P=S,K=R,V=_)):T>=E?(k=c,G=u,q=S,re=_,c>=0?(g=h,b=l,L=f,D=d,$=m,P=v,K=R,V=p):(g=l,b=h,L=d,D=f,$=v,P=m,K=p,V=R)):(k=h,G=f,q=m,re=R,h>=0?(g=l,b=c,L=d,D=u,$=v,P=S,K=p,V=_):(g=c,b=l,L=u,D=d,$=S,P=v,K=_,V=p)),k===0)return null;let X=g/k,te=b/k,ie=1/k,Ee=L-X*G,Fe=D-te*G,j=$-X*q,xe=P-te*q,be=K-X*re,Pe=V-te*re,ye=be*xe-Pe*j,ke=Ee*Pe-Fe*be,pt=j*Fe-xe*Ee;if(s){if(ye<0||ke<0||pt<0)return null}else if((ye<0||ke<0||pt<0)&&(ye>0||ke>0||pt>0))return null;let Ie=ye+ke+pt;if(Ie===0)return null;let et=ie*(ye*G+ke*q+pt*re);return(Ie>0?et<0:et>0)?null:this.at(et/Ie,r)}applyMatrix4(e){return this.origin.applyMatrix4(e),this.direction.transformDirection(e),this}equals(e){return e.origin.equals(this.origin)&&e.direction.equals(this.direction)}clone(){return new this.constructor().copy(this)}},ro=class extends Hn{constructor(e){super(),this.isMeshBasicMaterial=!0,this.type="MeshBasicMaterial",this.color=new Ze(16777215),this.map=null,this.lightMap=null,this.lightMapIntensity=1,this.aoMap=null,this.aoMapIntensity=1,this.specularMap=null,this.alphaMap=null,this.envMap=null,this.envMapRotation=new ci,this.combine=yl,this.reflectivity=1,this.refractionRatio=.98,this.wireframe=!1,this.wireframeLinewidth=1,this.wireframeLinecap="round",this.wireframeLinejoin="round",this.fog=!0,this.setValues(e)}copy(e){return super.copy(e),this.color.copy(e.color),this.map=e.map,this.lightMap=e.lightMap,this.lightMapIntensity=e.lightMapIntensity,this.aoMap=e.aoMap,this.aoMapIntensity=e.aoMapIntensity,this.specularMap=e.specularMap,this.alphaMap=e.alphaMap,this.envMap=e.envMap,this.envMapRotation.copy(e.envMapRotation),this.combine=e.combine,this.reflectivity=e.reflectivity,this.refractionRatio=e.refractionRatio,this.wireframe=e.wireframe,this.wireframeLinewidth=e.wireframeLinewidth,this.wireframeLinecap=e.wireframeLinecap,this.wireframeLinejoin=e.wireframeLinejoin,this.fog=e.fog,this}},ch=new lt,Ri=new ui,Cr=new dn,hh=new N,Pr=new N,Lr=new N,Ir=new N,sl=new N,Nr=new N,uh=new N,Dr=new N,Ht=class extends $t{constructor(e=new It,t=new ro){super(),this.isMesh=!0,this.type="Mesh",this.geometry=e,this.material=t,this.morphTargetDictionary=void 0,this.morphTargetInfluences=void 0,this.count=1,this.updateMorphTargets()}copy(e,t){return super.copy(e,t),e.morphTargetInfluences!==void 0?this.morphTargetInfluences=e.morphTargetInfluences.slice():this.morphTargetInfluences=void 0,e.morphTargetDictionary!==void 0?this.morphTargetDictionary=Object.assign({},e.morphTargetDictionary):this.morphTargetDictionary=void 0,this.material=Array.isArray(e.material)?e.material.slice():e.material,this.geometry=e.geometry,this}updateMorphTargets(){let t=this.geometry.morphAttributes,n=Object.keys(t);if(n.length>0){let s=t[n[0]];if(s!==void 0){this.morphTargetInfluences=[],this.morphTargetDictionary={};for(let r=0,o=s.length;r<o;r++){let a=s[r].name||String(r);this.morphTargetInfluences.push(0),this.morphTargetDictionary[a]=r}}}}getVertexPosition(e,t){let n=this.geometry,s=n.attributes.position,r=n.morphAttributes.position,o=n.morphTargetsRelative;t.fromBufferAttribute(s,e);let a=this.morphTargetInfluences;if(r&&a){Nr.set(0,0,0);for(let l=0,c=r.length;l<c;l++){let h=a[l],d=r[l];h!==0&&(sl.fromBufferAttribute(d,e),o?Nr.addScaledVector(sl,h):Nr.addScaledVector(sl.sub(t),h))}t.add(Nr)}return t}intersectsFrustum(e){return e.intersectsObject(this)}raycast(e,t){let n=this.geometry,s=this.material,r=this.matrixWorld;s!==void 0&&(n.boundingSphere===null&&n.computeBoundingSphere(),Cr.copy(n.boundingSphere),Cr.applyMatrix4(r),Ri.copy(e.ray).recast(e.near),!(Cr.containsPoint(Ri.origin)===!1&&(Ri.intersectSphere(Cr,hh)===null||Ri.origin.distanceToSquared(hh)>(e.far-e.near)**2))&&(ch.copy(r).invert(),Ri.copy(e.ray).applyMatrix4(ch),!(n.boundingBox!==null&&Ri.intersectsBox(n.boundingBox)===!1)&&this.bn(e,t,Ri)))}bn(e,t,n){let s,r=this.geometry,o=this.material,a=r.index,l=r.attributes.position,c=r.attributes.uv,h=r.attributes.uv1,d=r.attributes.normal,u=r.groups,f=r.drawRange;if(a!==null)if(Array.isArray(o))for(let v=0,S=u.length;v<S;v++){let m=u[v],p=o[m.materialIndex],_=Math.max(m.start,f.start),R=Math.min(a.count,Math.min(m.start+m.count,f.start+f.count));for(let w=_,T=R;w<T;w+=3){let E=a.getX(w),g=a.getX(w+1),b=a.getX(w+2);s=Ur(this,p,e,n,c,h,d,E,g,b),s&&(s.faceIndex=Math.floor(w/3),s.face.materialIndex=m.materialIndex,t.push(s))}}else{let v=Math.max(0,f.start),S=Math.min(a.count,f.start+f.count);for(let m=v,p=S;m<p;m+=3){let _=a.getX(m),R=a.getX(m+1),w=a.getX(m+2);s=Ur(this,o,e,n,c,h,d,_,R,w),s&&(s.faceIndex=Math.floor(m/3),t.push(s))}}else if(l!==void 0)if(Array.isArray(o))for(let v=0,S=u.length;v<S;v++){let m=u[v],p=o[m.materialIndex],_=Math.max(m.start,f.start),R=Math.min(l.count,Math.min(m.start+m.count,f.start+f.count));for(let w=_,T=R;w<T;w+=3){let E=w,g=w+1,b=w+2;s=Ur(this,p,e,n,c,h,d,E,g,b),s&&(s.faceIndex=Math.floor(w/3),s.face.materialIndex=m.materialIndex,t.push(s))}}else{let v=Math.max(0,f.start),S=Math.min(l.count,f.start+f.count);for(let m=v,p=S;m<p;m+=3){let _=m,R=m+1,w=m+2;s=Ur(this,o,e,n,c,h,d,_,R,w),s&&(s.faceIndex=Math.floor(m/3),t.push(s))}}}};function Wf(i,e,t,n,s,r,o,a){let l;if(e.side===Nt?l=n.intersectTriangle(o,r,s,!0,a):l=n.intersectTriangle(s,r,o,e.side===Rn,a),l===null)return null;Dr.copy(a),Dr.applyMatrix4(i.matrixWorld);let c=t.ray.origin.distanceTo(Dr);return c<t.near||c>t.far?null:{distance:c,point:Dr.clone(),object:i}}function Ur(i,e,t,n,s,r,o,a,l,c){i.getVertexPosition(a,Pr),i.getVertexPosition(l,Lr),i.getVertexPosition(c,Ir);let h=Wf(i,e,t,n,Pr,Lr,Ir,uh);if(h){let d=new N;li.getBarycoord(uh,Pr,Lr,Ir,d),s&&(h.uv=li.getInterpolatedAttribute(s,a,l,c,d,new De)),r&&(h.uv1=li.getInterpolatedAttribute(r,a,l,c,d,new De)),o&&(h.normal=li.getInterpolatedAttribute(o,a,l,c,d,new N),h.normal.dot(n.direction)>0&&h.normal.multiplyScalar(-1));let u={a,b:l,c,normal:new N,materialIndex:0};li.getNormal(Pr,Lr,Ir,u.normal),h.face=u,h.barycoord=d}return h}var oo=class extends Yt{constructor(e=null,t=1,n=1,s,r,o,a,l,c=Tt,h=Tt,d,u){super(null,o,a,l,c,h,s,r,d,u),this.isDataTexture=!0,this.image={data:e,width:t,height:n},this.generateMipmaps=!1,this.flipY=!1,this.unpackAlignment=1}};var Ci=new dn,Xf=new De(.5,.5),Or=new N,Wn=class{constructor(e=new Qt,t=new Qt,n=new Qt,s=new Qt,r=new Qt,o=new Qt){this.planes=[e,t,n,s,r,o]}set(e,t,n,s,r,o){let a=this.planes;return a[0].copy(e),a[1].copy(t),a[2].copy(n),a[3].copy(s),a[4].copy(r),a[5].copy(o),this}copy(e){let t=this.planes;for(let n=0;n<6;n++)t[n].copy(e.planes[n]);return this}setFromProjectionMatrix(e,t=hn,n=!1){let s=this.planes,r=e.elements,o=r[0],a=r[1],l=r[2],c=r[3],h=r[4],d=r[5],u=r[6],f=r[7],v=r[8],S=r[9],m=r[10],p=r[11],_=r[12],R=r[13],w=r[14],T=r[15];if(s[0].setComponents(c-o,f-h,p-v,T-_).normalize(),s[1].setComponents(c+o,f+h,p+v,T+_).normalize(),s[2].setComponents(c+a,f+d,p+S,T+R).normalize(),s[3].setComponents(c-a,f-d,p-S,T-R).normalize(),n)s[4].setComponents(l,u,m,w).normalize(),s[5].setComponents(c-l,f-u,p-m,T-w).normalize();else if(s[4].setComponents(c-l,f-u,p-m,T-w).normalize(),t===hn)s[5].setComponents(c+l,f+u,p+m,T+w).normalize();else if(t===Ns)s[5].setComponents(l,u,m,w).normalize();else throw new Error("THREE.Frustum.setFromProjectionMatrix(): Invalid coordinate system: "+t);return this}intersectsObject(e){if(e.boundingSphere!==void 0)e.boundingSphere===null&&e.computeBoundingSphere(),Ci.copy(e.boundingSphere).applyMatrix4(e.matrixWorld);else{let t=e.geometry;t.boundingSphere===null&&t.computeBoundingSphere(),Ci.copy(t.boundingSphere).applyMatrix4(e.matrixWorld)}return this.intersectsSphere(Ci)}intersectsSprite(e){Ci.center.set(0,0,0);let t=Xf.distanceTo(e.center);return Ci.radius=.7071067811865476+t,Ci.applyMatrix4(e.matrixWorld),this.intersectsSphere(Ci)}intersectsSphere(e){let t=this.planes,n=e.center,s=-e.radius;for(let r=0;r<6;r++)if(t[r].distanceToPoint(n)<s)return!1;return!0}intersectsBox(e){let t=this.planes;for(let n=0;n<6;n++){let s=t[n];if(Or.x=s.normal.x>0?e.max.x:e.min.x,Or.y=s.normal.y>0?e.max.y:e.min.y,Or.z=s.normal.z>0?e.max.z:e.min.z,s.distanceToPoint(Or)<0)return!1}return!0}containsPoint(e){let t=this.planes;for(let n=0;n<6;n++)if(t[n].distanceToPoint(e)<0)return!1;return!0}clone(){return new this.constructor().copy(this)}},dh=new lt,ao=class i{constructor(){this.coordinateSystem=hn,this.ne=[],this.ie=0}setFromArrayCamera(e){let t=e.cameras,n=this.ne;for(let s=0;s<t.length;s++){let r=t[s];dh.multiplyMatrices(r.projectionMatrix,r.matrixWorldInverse),n[s]===void 0&&(n[s]=new Wn),n[s].setFromProjectionMatrix(dh,r.coordinateSystem,r.reversedDepth)}return this.ie=t.length,this}getFrustum(e){return this.ne[e]}intersectsObject(e){let t=this.ne;for(let n=0;n<this.ie;n++)if(t[n].intersectsObject(e))return!0;return!1}intersectsSprite(e){let t=this.ne;for(let n=0;n<this.ie;n++)if(t[n].intersectsSprite(e))return!0;return!1}intersectsSphere(e){let t=this.ne;for(let n=0;n<this.ie;n++)if(t[n].intersectsSphere(e))return!0;return!1}intersectsBox(e){let t=this.ne;for(let n=0;n<this.ie;n++)if(t[n].intersectsBox(e))return!0;return!1}containsPoint(e){let t=this.ne;for(let n=0;n<this.ie;n++)if(t[n].containsPoint(e))return!0;return!1}copy(e){this.coordinateSystem=e.coordinateSystem;let t=this.ne,n=e.ne;for(let s=0;s<e.ie;s++)t[s]===void 0&&(t[s]=new Wn),t[s].copy(n[s]);return this.ie=e.ie,this}clone(){return new i().copy(this)}};var rs=class extends Hn{constructor(e){super(),this.isLineBasicMaterial=!0,this.type="LineBasicMaterial",this.color=new Ze(16777215),this.map=null,this.linewidth=1,this.linecap="round",this.linejoin="round",this.fog=!0,this.setValues(e)}copy(e){return super.copy(e),this.color.copy(e.color),this.map=e.map,this.linewidth=e.linewidth,this.linecap=e.linecap,this.linejoin=e.linejoin,this.fog=e.fog,this}},lo=new N,co=new N,fh=new lt,As=new ui,Fr=new dn,rl=new N,ph=new N,ho=class extends $t{constructor(e=new It,t=new rs){super(),this.isLine=!0,this.type="Line",this.geometry=e,this.material=t,this.morphTargetDictionary=void 0,this.morphTargetInfluences=void 0,this.updateMorphTargets()}copy(e,t){return super.copy(e,t),e.morphTargetInfluences!==void 0?this.morphTargetInfluences=e.morphTargetInfluences.slice():this.morphTargetInfluences=void 0,e.morphTargetDictionary!==void 0?this.morphTargetDictionary=Object.assign({},e.morphTargetDictionary):this.morphTargetDictionary=void 0,this.material=Array.isArray(e.material)?e.material.slice():e.material,this.geometry=e.geometry,this}computeLineDistances(){let e=this.geometry;if(e.index===null){let t=e.attributes.position,n=[0];for(let s=1,r=t.count;s<r;s++)lo.fromBufferAttribute(t,s-1),co.fromBufferAttribute(t,s),n[s]=n[s-1],n[s]+=lo.distanceTo(co);e.setAttribute("lineDistance",new qt(n,1))}else Ce("Line.computeLineDistances(): Computation only possible with non-indexed BufferGeometry.");return this}intersectsFrustum(e){return e.intersectsObject(this)}raycast(e,t){let n=this.geometry,s=this.matrixWorld,r=e.params.Line.threshold,o=n.drawRange;if(n.boundingSphere===null&&n.computeBoundingSphere(),Fr.copy(n.boundingSphere),Fr.applyMatrix4(s),Fr.radius+=r,e.ray.intersectsSphere(Fr)===!1)return;fh.copy(s).invert(),As.copy(e.ray).applyMatrix4(fh);let a=r/((this.scale.x+this.scale.y+this.scale.z)/3),l=a*a,c=this.isLineSegments?2:1,h=n.index,u=n.attributes.position;if(h!==null){let f=Math.max(0,o.start),v=Math.min(h.count,o.start+o.count);for(let S=f,m=v-1;S<m;S+=c){let p=h.getX(S),_=h.getX(S+1),R=Br(this,e,As,l,p,_,S);R&&t.push(R)}if(this.isLineLoop){let S=h.getX(v-1),m=h.getX(f),p=Br(this,e,As,l,S,m,v-1);p&&t.push(p)}}else{let f=Math.max(0,o.start),v=Math.min(u.count,o.start+o.count);for(let S=f,m=v-1;S<m;S+=c){let p=Br(this,e,As,l,S,S+1,S);p&&t.push(p)}if(this.isLineLoop){let S=Br(this,e,As,l,v-1,f,v-1);S&&t.push(S)}}}updateMorphTargets(){let t=this.geometry.morphAttributes,n=Object.keys(t);if(n.length>0){let s=t[n[0]];if(s!==void 0){this.morphTargetInfluences=[],this.morphTargetDictionary={};for(let r=0,o=s.length;r<o;r++){let a=s[r].name||String(r);this.morphTargetInfluences.push(0),this.morphTargetDictionary[a]=r}}}}};function Br(i,e,t,n,s,r,o){let a=i.geometry.attributes.position;if(lo.fromBufferAttribute(a,s),co.fromBufferAttribute(a,r),t.distanceSqToSegment(lo,co,rl,ph)>n)return;rl.applyMatrix4(i.matrixWorld);let c=e.ray.origin.distanceTo(rl);if(!(c<e.near||c>e.far))return{distance:c,point:ph.clone().applyMatrix4(i.matrixWorld),index:o,face:null,faceIndex:null,barycoord:null,object:i}}var mh=new N,gh=new N,zs=class extends ho{constructor(e,t){super(e,t),this.isLineSegments=!0,this.type="LineSegments"}computeLineDistances(){let e=this.geometry;if(e.index===null){let t=e.attributes.position,n=[];for(let s=0,r=t.count;s<r;s+=2)mh.fromBufferAttribute(t,s),gh.fromBufferAttribute(t,s+1),n[s]=s===0?0:n[s-1],n[s+1]=n[s]+mh.distanceTo(gh);e.setAttribute("lineDistance",new qt(n,1))}else Ce("LineSegments.computeLineDistances(): Computation only possible with non-indexed BufferGeometry.");return this}};var uo=class extends Hn{constructor(e){super(),this.isPointsMaterial=!0,this.type="PointsMaterial",this.color=new Ze(16777215),this.map=null,this.alphaMap=null,this.size=1,this.sizeAttenuation=!0,this.fog=!0,this.setValues(e)}copy(e){return super.copy(e),this.color.copy(e.color),this.map=e.map,this.alphaMap=e.alphaMap,this.size=e.size,this.sizeAttenuation=e.sizeAttenuation,this.fog=e.fog,this}},vh=new lt,hl=new ui,kr=new dn,zr=new N,Gs=class extends $t{constructor(e=new It,t=new uo){super(),this.isPoints=!0,this.type="Points",this.geometry=e,this.material=t,this.morphTargetDictionary=void 0,this.morphTargetInfluences=void 0,this.updateMorphTargets()}copy(e,t){return super.copy(e,t),e.morphTargetInfluences!==void 0?this.morphTargetInfluences=e.morphTargetInfluences.slice():this.morphTargetInfluences=void 0,e.morphTargetDictionary!==void 0?this.morphTargetDictionary=Object.assign({},e.morphTargetDictionary):this.morphTargetDictionary=void 0,this.material=Array.isArray(e.material)?e.material.slice():e.material,this.geometry=e.geometry,this}intersectsFrustum(e){return e.intersectsObject(this)}raycast(e,t){let n=this.geometry,s=this.matrixWorld,r=e.params.Points.threshold,o=n.drawRange;if(n.boundingSphere===null&&n.computeBoundingSphere(),kr.copy(n.boundingSphere),kr.applyMatrix4(s),kr.radius+=r,e.ray.intersectsSphere(kr)===!1)return;vh.copy(s).invert(),hl.copy(e.ray).applyMatrix4(vh);let a=r/((this.scale.x+this.scale.y+this.scale.z)/3),l=a*a,c=n.index,d=n.attributes.position;if(c!==null){let u=Math.max(0,o.start),f=Math.min(c.count,o.start+o.count);for(let v=u,S=f;v<S;v++){let m=c.getX(v);zr.fromBufferAttribute(d,m),xh(zr,m,l,s,e,t,this)}}else{let u=Math.max(0,o.start),f=Math.min(d.count,o.start+o.count);for(let v=u,S=f;v<S;v++)zr.fromBufferAttribute(d,v),xh(zr,v,l,s,e,t,this)}}updateMorphTargets(){let t=this.geometry.morphAttributes,n=Object.keys(t);if(n.length>0){let s=t[n[0]];if(s!==void 0){this.morphTargetInfluences=[],this.morphTargetDictionary={};for(let r=0,o=s.length;r<o;r++){let a=s[r].name||String(r);this.morphTargetInfluences.push(0),this.morphTargetDictionary[a]=r}}}}};function xh(i,e,t,n,s,r,o){let a=hl.distanceSqToPoint(i);if(a<t){let l=new N;hl.closestPointToPoint(i,l),l.applyMatrix4(n);let c=s.ray.origin.distanceTo(l);if(c<s.near||c>s.far)return;r.push({distance:c,distanceToRay:Math.sqrt(a),point:l,index:e,face:null,faceIndex:null,barycoord:null,object:o})}}var Vs=class extends Yt{constructor(e=[],t=Ii,n,s,r,o,a,l,c,h){super(e,t,n,s,r,o,a,l,c,h),this.isCubeTexture=!0,this.flipY=!1}get images(){return this.image}set images(e){this.image=e}};var Xn=class extends Yt{constructor(e,t,n=yn,s,r,o,a=Tt,l=Tt,c,h=Vn,d=1){if(h!==Vn&&h!==Yn)throw new Error("THREE.DepthTexture: format must be either THREE.DepthFormat or THREE.DepthStencilFormat");let u={width:e,height:t,depth:d};super(u,s,r,o,a,l,h,n,c),this.isDepthTexture=!0,this.flipY=!1,this.generateMipmaps=!1,this.compareFunction=null}copy(e){return super.copy(e),this.source=new is(Object.assign({},e.image)),this.compareFunction=e.compareFunction,this}toJSON(e){let t=super.toJSON(e);return t.compareFunction=this.compareFunction,t}},Hs=class extends Xn{constructor(e,t=yn,n=Ii,s,r,o=Tt,a=Tt,l,c=Vn){let h={width:e,height:e,depth:1},d=[h,h,h,h,h,h];super(e,e,t,n,s,r,o,a,l,c),this.image=d,this.isCubeDepthTexture=!0,this.isCubeTexture=!0}get images(){return this.image}set images(e){this.image=e}},Ws=class extends Yt{constructor(e=null){super(),this.sourceTexture=e,this.isExternalTexture=!0}copy(e){return super.copy(e),this.sourceTexture=e.sourceTexture,this}},os=class i extends It{constructor(e=1,t=1,n=1,s=1,r=1,o=1){super(),this.type="BoxGeometry",this.parameters={width:e,height:t,depth:n,widthSegments:s,heightSegments:r,depthSegments:o};let a=this;s=Math.floor(s),r=Math.floor(r),o=Math.floor(o);let l=[],c=[],h=[],d=[],u=0,f=0;v("z","y","x",-1,-1,n,t,e,o,r,0),v("z","y","x",1,-1,n,t,-e,o,r,1),v("x","z","y",1,1,e,n,t,s,o,2),v("x","z","y",1,-1,e,n,-t,s,o,3),v("x","y","z",1,-1,e,t,n,s,r,4),v("x","y","z",-1,-1,e,t,-n,s,r,5),this.setIndex(l),this.setAttribute("position",new qt(c,3)),this.setAttribute("normal",new qt(h,3)),this.setAttribute("uv",new qt(d,2));function v(S,m,p,_,R,w,T,E,g,b,k){let L=w/g,D=T/b,G=w/2,$=T/2,P=E/2,q=g+1,K=b+1,V=0,re=0,X=new N;for(let te=0;te<K;te++){let ie=te*D-$;for(let Ee=0;Ee<q;Ee++){let Fe=Ee*L-G;X[S]=Fe*_,X[m]=ie*R,X[p]=P,c.push(X.x,X.y,X.z),X[S]=0,X[m]=0,X[p]=E>0?1:-1,h.push(X.x,X.y,X.z),d.push(Ee/g),d.push(1-te/b),V+=1}}for(let te=0;te<b;te++)for(let ie=0;ie<g;ie++){let Ee=u+ie+q*te,Fe=u+ie+q*(te+1),j=u+(ie+1)+q*(te+1),xe=u+(ie+1)+q*te;l.push(Ee,Fe,xe),l.push(Fe,j,xe),re+=6}a.addGroup(f,re,k),f+=re,u+=V}}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}static fromJSON(e){return new i(e.width,e.height,e.depth,e.widthSegments,e.heightSegments,e.depthSegments)}};var Xs=class i extends It{constructor(e=1,t=1,n=1,s=1){super(),this.type="PlaneGeometry",this.parameters={width:e,height:t,widthSegments:n,heightSegments:s};let r=e/2,o=t/2,a=Math.floor(n),l=Math.floor(s),c=a+1,h=l+1,d=e/a,u=t/l,f=[],v=[],S=[],m=[];for(let p=0;p<h;p++){let _=p*u-o;for(let R=0;R<c;R++){let w=R*d-r;v.push(w,-_,0),S.push(0,0,1),m.push(R/a),m.push(1-p/l)}}for(let p=0;p<l;p++)for(let _=0;_<a;_++){let R=_+c*p,w=_+c*(p+1),T=_+1+c*(p+1),E=_+1+c*p;f.push(R,w,E),f.push(w,T,E)}this.setIndex(f),this.setAttribute("position",new qt(v,3)),this.setAttribute("normal",new qt(S,3)),this.setAttribute("uv",new qt(m,2))}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}static fromJSON(e){return new i(e.width,e.height,e.widthSegments,e.heightSegments)}};function Ui(i){let e={};for(let t in i){e[t]={};for(let n in i[t]){let s=i[t][n];if(yh(s))s.isRenderTargetTexture?(Ce("UniformsUtils: Textures of render targets cannot be cloned via cloneUniforms() or mergeUniforms()."),e[t][n]=null):e[t][n]=s.clone();else if(Array.isArray(s))if(yh(s[0])){let r=[];for(let o=0,a=s.length;o<a;o++)r[o]=s[o].clone();e[t][n]=r}else e[t][n]=s.slice();else e[t][n]=s}}return e}function kt(i){let e={};for(let t=0;t<i.length;t++){let n=Ui(i[t]);for(let s in n)e[s]=n[s]}return e}function yh(i){return i&&(i.isColor||i.isMatrix3||i.isMatrix4||i.isVector2||i.isVector3||i.isVector4||i.isTexture||i.isQuaternion)}function qf(i){let e=[];for(let t=0;t<i.length;t++)e.push(i[t].clone());return e}function Wl(i){let e=i.getRenderTarget();return e===null?i.outputColorSpace:e.isXRRenderTarget===!0?e.texture.colorSpace:Ye.workingColorSpace}var hu={clone:Ui,merge:kt},Yf=`void main() {
gl_Position = projectionMatrix * modelViewMatrix * vec4( position, 1.0 );
}`,$f=`void main() {
gl_FragColor = vec4( 1.0, 0.0, 0.0, 1.0 );
}`,Tn=class extends Hn{constructor(e){super(),this.isShaderMaterial=!0,this.type="ShaderMaterial",this.defines={},this.uniforms={},this.uniformsGroups=[],this.vertexShader=Yf,this.fragmentShader=$f,this.linewidth=1,this.wireframe=!1,this.wireframeLinewidth=1,this.fog=!1,this.lights=!1,this.clipping=!1,this.forceSinglePass=!0,this.extensions={clipCullDistance:!1,multiDraw:!1},this.defaultAttributeValues={color:[1,1,1],uv:[0,0],uv1:[0,0]},this.index0AttributeName=void 0,this.uniformsNeedUpdate=!1,this.glslVersion=null,e!==void 0&&this.setValues(e)}copy(e){return super.copy(e),this.fragmentShader=e.fragmentShader,this.vertexShader=e.vertexShader,this.uniforms=Ui(e.uniforms),this.uniformsGroups=qf(e.uniformsGroups),this.defines=Object.assign({},e.defines),this.wireframe=e.wireframe,this.wireframeLinewidth=e.wireframeLinewidth,this.fog=e.fog,this.lights=e.lights,this.clipping=e.clipping,this.extensions=Object.assign({},e.extensions),this.glslVersion=e.glslVersion,this.defaultAttributeValues=Object.assign({},e.defaultAttributeValues),this.index0AttributeName=e.index0AttributeName,this.uniformsNeedUpdate=e.uniformsNeedUpdate,this}toJSON(e){let t=super.toJSON(e);t.glslVersion=this.glslVersion,t.uniforms={};for(let s in this.uniforms){let o=this.uniforms[s].value;o&&o.isTexture?t.uniforms[s]={type:"t",value:o.toJSON(e).uuid}:o&&o.isColor?t.uniforms[s]={type:"c",value:o.getHex()}:o&&o.isVector2?t.uniforms[s]={type:"v2",value:o.toArray()}:o&&o.isVector3?t.uniforms[s]={type:"v3",value:o.toArray()}:o&&o.isVector4?t.uniforms[s]={type:"v4",value:o.toArray()}:o&&o.isMatrix3?t.uniforms[s]={type:"m3",value:o.toArray()}:o&&o.isMatrix4?t.uniforms[s]={type:"m4",value:o.toArray()}:t.uniforms[s]={value:o}}Object.keys(this.defines).length>0&&(t.defines=this.defines),t.vertexShader=this.vertexShader,t.fragmentShader=this.fragmentShader,t.lights=this.lights,t.clipping=this.clipping;let n={};for(let s in this.extensions)this.extensions[s]===!0&&(n[s]=!0);return Object.keys(n).length>0&&(t.extensions=n),t}fromJSON(e,t){if(super.fromJSON(e,t),e.uniforms!==void 0)for(let n in e.uniforms){let s=e.uniforms[n];switch(this.uniforms[n]={},s.type){case"t":this.uniforms[n].value=t[s.value]||null;break;case"c":this.uniforms[n].value=new Ze().setHex(s.value);break;case"v2":this.uniforms[n].value=new De().fromArray(s.value);break;case"v3":this.uniforms[n].value=new N().fromArray(s.value);break;case"v4":this.uniforms[n].value=new dt().fromArray(s.value);break;case"m3":this.uniforms[n].value=new Ue().fromArray(s.value);break;case"m4":this.uniforms[n].value=new lt().fromArray(s.value);break;default:this.uniforms[n].value=s.value}}if(e.defines!==void 0&&(this.defines=e.defines),e.vertexShader!==void 0&&(this.vertexShader=e.vertexShader),e.fragmentShader!==void 0&&(this.fragmentShader=e.fragmentShader),e.glslVersion!==void 0&&(this.glslVersion=e.glslVersion),e.extensions!==void 0)for(let n in e.extensions)this.extensions[n]=e.extensions[n];return e.lights!==void 0&&(this.lights=e.lights),e.clipping!==void 0&&(this.clipping=e.clipping),this}},di=class extends Tn{constructor(e){super(e),this.isRawShaderMaterial=!0,this.type="RawShaderMaterial"}};var fo=class extends Hn{constructor(e){super(),this.isMeshDepthMaterial=!0,this.type="MeshDepthMaterial",this.depthPacking=$h,this.map=null,this.alphaMap=null,this.displacementMap=null,this.displacementScale=1,this.displacementBias=0,this.wireframe=!1,this.wireframeLinewidth=1,this.setValues(e)}copy(e){return super.copy(e),this.depthPacking=e.depthPacking,this.map=e.map,this.alphaMap=e.alphaMap,this.displacementMap=e.displacementMap,this.displacementScale=e.displacementScale,this.displacementBias=e.displacementBias,this.wireframe=e.wireframe,this.wireframeLinewidth=e.wireframeLinewidth,this}},po=class extends Hn{constructor(e){super(),this.isMeshDistanceMaterial=!0,this.type="MeshDistanceMaterial",this.map=null,this.alphaMap=null,this.displacementMap=null,this.displacementScale=1,this.displacementBias=0,this.setValues(e)}copy(e){return super.copy(e),this.map=e.map,this.alphaMap=e.alphaMap,this.displacementMap=e.displacementMap,this.displacementScale=e.displacementScale,this.displacementBias=e.displacementBias,this}};function ji(i,e){return!i||i.constructor===e?i:typeof e.BYTES_PER_ELEMENT=="number"?new e(i):Array.prototype.slice.call(i)}function Gr(i){return i!==void 0&&i.inTangents!==void 0&&i.outTangents!==void 0}var fi=class{constructor(e,t,n,s){this.parameterPositions=e,this.Ie=0,this.resultBuffer=s!==void 0?s:new t.constructor(n),this.sampleValues=t,this.valueSize=n,this.settings=null,this.DefaultSettings_={}}evaluate(e){let t=this.parameterPositions,n=this.Ie,s=t[n],r=t[n-1];n:{e:{let o;t:{i:if(!(e<s)){for(let a=n+2;;){if(s===void 0){if(e<r)break i;return n=t.length,this.Ie=n,this.copySampleValue_(n-1)}if(n===a)break;if(r=s,s=t[++n],e<s)break e}o=t.length;break t}if(!(e>=r)){let a=t[1];e<a&&(n=2,r=a);for(let l=n-2;;){if(r===void 0)return this.Ie=0,this.copySampleValue_(0);if(n===l)break;if(s=r,r=t[--n-1],e>=r)break e}o=n,n=0;break t}break n}for(;n<o;){let a=n+o>>>1;e<t[a]?o=a:n=a+1}if(s=t[n],r=t[n-1],r===void 0)return this.Ie=0,this.copySampleValue_(0);if(s===void 0)return n=t.length,this.Ie=n,this.copySampleValue_(n-1)}this.Ie=n,this.intervalChanged_(n,r,s)}return this.interpolate_(n,r,e,s)}getSettings_(){return this.settings||this.DefaultSettings_}copySampleValue_(e){let t=this.resultBuffer,n=this.sampleValues,s=this.valueSize,r=e*s;for(let o=0;o!==s;++o)t[o]=n[r+o];return t}interpolate_(){throw new Error("THREE.Interpolant: Call to abstract method.")}intervalChanged_(){}},mo=class extends fi{constructor(e,t,n,s){super(e,t,n,s),this.Cn=-0,this.Pn=-0,this.Ln=-0,this.In=-0,this.DefaultSettings_={endingStart:al,endingEnd:al}}intervalChanged_(e,t,n){let s=this.parameterPositions,r=e-2,o=e+1,a=s[r],l=s[o];if(a===void 0)switch(this.getSettings_().endingStart){case ll:r=e,a=2*t-n;break;case cl:r=s.length-2,a=t+s[r]-s[r+1];break;default:r=e,a=n}if(l===void 0)switch(this.getSettings_().endingEnd){case ll:o=e,l=2*n-t;break;case cl:o=1,l=n+s[1]-s[0];break;default:o=e-1,l=t}let c=(n-t)*.5,h=this.valueSize;this.Cn=c/(t-a),this.Ln=c/(l-n),this.Pn=r*h,this.In=o*h}interpolate_(e,t,n,s){let r=this.resultBuffer,o=this.sampleValues,a=this.valueSize,l=e*a,c=l-a,h=this.Pn,d=this.In,u=this.Cn,f=this.Ln,v=(n-t)/(s-t),S=v*v,m=S*v,p=-u*m+2*u*S-u*v,_=(1+u)*m+(-1.5-2*u)*S+(-.5+u)*v+1,R=(-1-f)*m+(1.5+f)*S+.5*v,w=f*m-f*S;for(let T=0;T!==a;++T)r[T]=p*o[h+T]+_*o[c+T]+R*o[l+T]+w*o[d+T];return r}},go=class extends fi{constructor(e,t,n,s){super(e,t,n,s)}interpolate_(e,t,n,s){let r=this.resultBuffer,o=this.sampleValues,a=this.valueSize,l=e*a,c=l-a,h=(n-t)/(s-t),d=1-h;for(let u=0;u!==a;++u)r[u]=o[c+u]*d+o[l+u]*h;return r}},vo=class extends fi{constructor(e,t,n,s){super(e,t,n,s)}interpolate_(e){return this.copySampleValue_(e-1)}},xo=class extends fi{interpolate_(e,t,n,s){let r=this.resultBuffer,o=this.sampleValues,a=this.valueSize,l=e*a,c=l-a,h=this.inTangents,d=this.outTangents;if(!h||!d){let v=(n-t)/(s-t),S=1-v;for(let m=0;m!==a;++m)r[m]=o[c+m]*S+o[l+m]*v;return r}let u=a*2,f=e-1;for(let v=0;v!==a;++v){let S=o[c+v],m=o[l+v],p=f*u+v*2,_=d[p],R=d[p+1],w=e*u+v*2,T=h[w],E=h[w+1],g=jf(n,t,_,T,s);r[v]=uu(g,S,R,E,m)}return r}};function uu(i,e,t,n,s){let r=1-i;return r*r*r*e+3*r*r*i*t+3*r*i*i*n+i*i*i*s}function Zf(i,e,t,n,s){let r=1-i;return 3*r*r*(t-e)+6*r*i*(n-t)+3*i*i*(s-n)}function jf(i,e,t,n,s){let r=(i-e)/(s-e);for(let o=0;o<8;o++){let a=uu(r,e,t,n,s)-i;if(Math.abs(a)<1e-10)break;let l=Zf(r,e,t,n,s);if(Math.abs(l)<1e-10)break;r=Math.max(0,Math.min(1,r-a/l))}return r}var nn=class{constructor(e,t,n,s){if(e===void 0)throw new Error("THREE.KeyframeTrack: track name is undefined");if(t===void 0||t.length===0)throw new Error("THREE.KeyframeTrack: no keyframes in track named "+e);this.name=e,this.times=ji(t,this.TimeBufferType),this.values=ji(n,this.ValueBufferType),this.setInterpolation(s||this.DefaultInterpolation)}static toJSON(e){let t=e.constructor,n;if(t.toJSON!==this.toJSON)n=t.toJSON(e);else{n={name:e.name,times:ji(e.times,Array),values:ji(e.values,Array)};let s=e.getInterpolation();s!==e.DefaultInterpolation&&(n.interpolation=s),Gr(e.settings)&&(n.settings={inTangents:ji(e.settings.inTangents,Array),outTangents:ji(e.settings.outTangents,Array)})}return n.type=e.ValueTypeName,n}InterpolantFactoryMethodDiscrete(e){return new vo(this.times,this.values,this.getValueSize(),e)}InterpolantFactoryMethodLinear(e){return new go(this.times,this.values,this.getValueSize(),e)}InterpolantFactoryMethodSmooth(e){return new mo(this.times,this.values,this.getValueSize(),e)}InterpolantFactoryMethodBezier(e){let t=new xo(this.times,this.values,this.getValueSize(),e);return this.settings&&(t.inTangents=this.settings.inTangents,t.outTangents=this.settings.outTangents),t}setInterpolation(e){let t;switch(e){case Ps:t=this.InterpolantFactoryMethodDiscrete;break;case to:t=this.InterpolantFactoryMethodLinear;break;case Wr:t=this.InterpolantFactoryMethodSmooth;break;case ol:t=this.InterpolantFactoryMethodBezier;break}if(t===void 0){let n="unsupported interpolation for "+this.ValueTypeName+" keyframe track named "+this.name;if(this.createInterpolant===void 0)if(e!==this.DefaultInterpolation)this.setInterpolation(this.DefaultInterpolation);else throw new Error(n);return Ce("KeyframeTrack:",n),this}return this.createInterpolant=t,this}getInterpolation(){switch(this.createInterpolant){case this.InterpolantFactoryMethodDiscrete:return Ps;case this.InterpolantFactoryMethodLinear:return to;case this.InterpolantFactoryMethodSmooth:return Wr;case this.InterpolantFactoryMethodBezier:return ol}}getValueSize(){return this.values.length/this.times.length}shift(e){if(e!==0){let t=this.times;for(let n=0,s=t.length;n!==s;++n)t[n]+=e;Gr(this.settings)&&(Sh(this.settings.inTangents,e),Sh(this.settings.outTangents,e))}return this}scale(e){if(e!==1){let t=this.times;for(let n=0,s=t.length;n!==s;++n)t[n]*=e;Gr(this.settings)&&(Mh(this.settings.inTangents,e),Mh(this.settings.outTangents,e))}return this}trim(e,t){let n=this.times,s=n.length,r=0,o=s-1;for(;r!==s&&n[r]<e;)++r;for(;o!==-1&&n[o]>t;)--o;if(++o,r!==0||o!==s){r>=o&&(o=Math.max(o,1),r=o-1);let a=this.getValueSize();this.times=n.slice(r,o),this.values=this.values.slice(r*a,o*a)}return this}validate(){let e=!0,t=this.getValueSize();t-Math.floor(t)!==0&&(Ne("KeyframeTrack: Invalid value size in track.",this),e=!1);let n=this.times,s=this.values,r=n.length;r===0&&(Ne("KeyframeTrack: Track is empty.",this),e=!1);let o=null;for(let a=0;a!==r;a++){let l=n[a];if(typeof l=="number"&&isNaN(l)){Ne("KeyframeTrack: Time is not a valid number.",this,a,l),e=!1;break}if(o!==null&&o>l){Ne("KeyframeTrack: Out of order keys.",this,a,l,o),e=!1;break}o=l}if(s!==void 0&&df(s))for(let a=0,l=s.length;a!==l;++a){let c=s[a];if(isNaN(c)){Ne("KeyframeTrack: Value is not a valid number.",this,a,c),e=!1;break}}return e}optimize(){let e=this.times.slice(),t=this.values.slice(),n=this.getValueSize(),s=this.getInterpolation()===Wr,r=e.length-1,o=1;for(let a=1;a<r;++a){let l=!1,c=e[a],h=e[a+1];if(c!==h&&(a!==1||c!==e[0]))if(s)l=!0;else{let d=a*n,u=d-n,f=d+n;for(let v=0;v!==n;++v){let S=t[d+v];if(S!==t[u+v]||S!==t[f+v]){l=!0;break}}}if(l){if(a!==o){e[o]=e[a];let d=a*n,u=o*n;for(let f=0;f!==n;++f)t[u+f]=t[d+f]}++o}}if(r>0){e[o]=e[r];for(let a=r*n,l=o*n,c=0;c!==n;++c)t[l+c]=t[a+c];++o}return o!==e.length?(this.times=e.slice(0,o),this.values=t.slice(0,o*n)):(this.times=e,this.values=t),this}clone(){let e=this.times.slice(),t=this.values.slice(),n=this.constructor,s=new n(this.name,e,t);return s.createInterpolant=this.createInterpolant,Gr(this.settings)&&(s.settings={inTangents:this.settings.inTangents.slice(),outTangents:this.settings.outTangents.slice()}),s}};function Sh(i,e){for(let t=0,n=i.length;t!==n;t+=2)i[t]+=e}function Mh(i,e){for(let t=0,n=i.length;t!==n;t+=2)i[t]*=e}nn.prototype.ValueTypeName="";nn.prototype.TimeBufferType=Float32Array;nn.prototype.ValueBufferType=Float32Array;nn.prototype.DefaultInterpolation=to;var pi=class extends nn{constructor(e,t,n){super(e,t,n)}};pi.prototype.ValueTypeName="bool";pi.prototype.ValueBufferType=Array;pi.prototype.DefaultInterpolation=Ps;pi.prototype.InterpolantFactoryMethodLinear=void 0;pi.prototype.InterpolantFactoryMethodSmooth=void 0;var yo=class extends nn{constructor(e,t,n,s){super(e,t,n,s)}};yo.prototype.ValueTypeName="color";var So=class extends nn{constructor(e,t,n,s){super(e,t,n,s)}};So.prototype.ValueTypeName="number";var Mo=class extends fi{constructor(e,t,n,s){super(e,t,n,s)}interpolate_(e,t,n,s){let r=this.resultBuffer,o=this.sampleValues,a=this.valueSize,l=(n-t)/(s-t),c=e*a;for(let h=c+a;c!==h;c+=4)en.slerpFlat(r,0,o,c-a,o,c,l);return r}},qs=class extends nn{constructor(e,t,n,s){super(e,t,n,s)}InterpolantFactoryMethodLinear(e){return new Mo(this.times,this.values,this.getValueSize(),e)}};qs.prototype.ValueTypeName="quaternion";qs.prototype.InterpolantFactoryMethodSmooth=void 0;var mi=class extends nn{constructor(e,t,n){super(e,t,n)}};mi.prototype.ValueTypeName="string";mi.prototype.ValueBufferType=Array;mi.prototype.DefaultInterpolation=Ps;mi.prototype.InterpolantFactoryMethodLinear=void 0;mi.prototype.InterpolantFactoryMethodSmooth=void 0;var bo=class extends nn{constructor(e,t,n,s){super(e,t,n,s)}};bo.prototype.ValueTypeName="vector";var _o=class{constructor(e,t,n){let s=this,r=!1,o=0,a=0,l,c=[];this.onStart=void 0,this.onLoad=e,this.onProgress=t,this.onError=n,this.W=null,this.itemStart=function(h){a++,r===!1&&s.onStart!==void 0&&s.onStart(h,o,a),r=!0},this.itemEnd=function(h){o++,s.onProgress!==void 0&&s.onProgress(h,o,a),o===a&&(r=!1,s.onLoad!==void 0&&s.onLoad())},this.itemError=function(h){s.onError!==void 0&&s.onError(h)},this.resolveURL=function(h){return h=h.normalize("NFC"),l?l(h):h},this.setURLModifier=function(h){return l=h,this},this.addHandler=function(h,d){return c.push(h,d),this},this.removeHandler=function(h){let d=c.indexOf(h);return d!==-1&&c.splice(d,2),this},this.getHandler=function(h){for(let d=0,u=c.length;d<u;d+=2){let f=c[d],v=c[d+1];if(f.global&&(f.lastIndex=0),f.test(h))return v}return null},this.abort=function(){return this.abortController.abort(),this.W=null,this}}get abortController(){return this.W||(this.W=new AbortController),this.W}},du=new _o,wo=class{constructor(e){this.manager=e!==void 0?e:du,this.crossOrigin="anonymous",this.withCredentials=!1,this.path="",this.resourcePath="",this.requestHeader={},this.priority="auto",this.cache="default"}load(){}loadAsync(e,t){let n=this;return new Promise(function(s,r){n.load(e,s,t,r)})}parse(){}setCrossOrigin(e){return this.crossOrigin=e,this}setWithCredentials(e){return this.withCredentials=e,this}setPath(e){return this.path=e,this}setResourcePath(e){return this.resourcePath=e,this}setRequestHeader(e){return this.requestHeader=e,this}setPriority(e){return this.priority=e,this}setCache(e){return this.cache=e,this}abort(){return this}};wo.DEFAULT_MATERIAL_NAME="__DEFAULT";var Vr=new N,Hr=new en,En=new N,Ys=class extends $t{constructor(){super(),this.isCamera=!0,this.type="Camera",this.matrixWorldInverse=new lt,this.projectionMatrix=new lt,this.projectionMatrixInverse=new lt,this.coordinateSystem=hn,this.Zt=!1}get reversedDepth(){return this.Zt}copy(e,t){return super.copy(e,t),this.matrixWorldInverse.copy(e.matrixWorldInverse),this.projectionMatrix.copy(e.projectionMatrix),this.projectionMatrixInverse.copy(e.projectionMatrixInverse),this.coordinateSystem=e.coordinateSystem,this}getWorldDirection(e){return super.getWorldDirection(e).negate()}updateMatrixWorld(e){super.updateMatrixWorld(e),this.matrixWorld.decompose(Vr,Hr,En),En.x===1&&En.y===1&&En.z===1?this.matrixWorldInverse.copy(this.matrixWorld).invert():this.matrixWorldInverse.compose(Vr,Hr,En.set(1,1,1)).invert()}updateWorldMatrix(e,t,n=!1){super.updateWorldMatrix(e,t,n),this.matrixWorld.decompose(Vr,Hr,En),En.x===1&&En.y===1&&En.z===1?this.matrixWorldInverse.copy(this.matrixWorld).invert():this.matrixWorldInverse.compose(Vr,Hr,En.set(1,1,1)).invert()}clone(){return new this.constructor().copy(this)}},ai=new N,bh=new De,_h=new De,Gt=class extends Ys{constructor(e=50,t=1,n=.1,s=2e3){super(),this.isPerspectiveCamera=!0,this.type="PerspectiveCamera",this.fov=e,this.zoom=1,this.near=n,this.far=s,this.focus=10,this.aspect=t,this.view=null,this.filmGauge=35,this.filmOffset=0,this.updateProjectionMatrix()}copy(e,t){return super.copy(e,t),this.fov=e.fov,this.zoom=e.zoom,this.near=e.near,this.far=e.far,this.focus=e.focus,this.aspect=e.aspect,this.view=e.view===null?null:Object.assign({},e.view),this.filmGauge=e.filmGauge,this.filmOffset=e.filmOffset,this}setFocalLength(e){let t=.5*this.getFilmHeight()/e;this.fov=ns*2*Math.atan(t),this.updateProjectionMatrix()}getFocalLength(){let e=Math.tan(Rs*.5*this.fov);return .5*this.getFilmHeight()/e}getEffectiveFOV(){return ns*2*Math.atan(Math.tan(Rs*.5*this.fov)/this.zoom)}getFilmWidth(){return this.filmGauge*Math.min(this.aspect,1)}getFilmHeight(){return this.filmGauge/Math.max(this.aspect,1)}getViewBounds(e,t,n){ai.set(-1,-1,.5).applyMatrix4(this.projectionMatrixInverse),t.set(ai.x,ai.y).multiplyScalar(-e/ai.z),ai.set(1,1,.5).applyMatrix4(this.projectionMatrixInverse),n.set(ai.x,ai.y).multiplyScalar(-e/ai.z)}getViewSize(e,t){return this.getViewBounds(e,bh,_h),t.subVectors(_h,bh)}setViewOffset(e,t,n,s,r,o){this.aspect=e/t,this.view===null&&(this.view={enabled:!0,fullWidth:1,fullHeight:1,offsetX:0,offsetY:0,width:1,height:1}),this.view.enabled=!0,this.view.fullWidth=e,this.view.fullHeight=t,this.view.offsetX=n,this.view.offsetY=s,this.view.width=r,this.view.height=o,this.updateProjectionMatrix()}clearViewOffset(){this.view!==null&&(this.view.enabled=!1),this.updateProjectionMatrix()}updateProjectionMatrix(){let e=this.near,t=e*Math.tan(Rs*.5*this.fov)/this.zoom,n=2*t,s=this.aspect*n,r=-.5*s,o=this.view;if(this.view!==null&&this.view.enabled){let l=o.fullWidth,c=o.fullHeight;r+=o.offsetX*s/l,t-=o.offsetY*n/c,s*=o.width/l,n*=o.height/c}let a=this.filmOffset;a!==0&&(r+=e*a/this.getFilmWidth()),this.projectionMatrix.makePerspective(r,r+s,t,t-n,e,this.far,this.coordinateSystem,this.reversedDepth),this.projectionMatrixInverse.copy(this.projectionMatrix).invert()}toJSON(e){let t=super.toJSON(e);return t.object.fov=this.fov,t.object.zoom=this.zoom,t.object.near=this.near,t.object.far=this.far,t.object.focus=this.focus,t.object.aspect=this.aspect,this.view!==null&&(t.object.view=Object.assign({},this.view)),t.object.filmGauge=this.filmGauge,t.object.filmOffset=this.filmOffset,t}};var Eo=class extends Ys{constructor(e=-1,t=1,n=1,s=-1,r=.1,o=2e3){super(),this.isOrthographicCamera=!0,this.type="OrthographicCamera",this.zoom=1,this.view=null,this.left=e,this.right=t,this.top=n,this.bottom=s,this.near=r,this.far=o,this.updateProjectionMatrix()}copy(e,t){return super.copy(e,t),this.left=e.left,this.right=e.right,this.top=e.top,this.bottom=e.bottom,this.near=e.near,this.far=e.far,this.zoom=e.zoom,this.view=e.view===null?null:Object.assign({},e.view),this}setViewOffset(e,t,n,s,r,o){this.view===null&&(this.view={enabled:!0,fullWidth:1,fullHeight:1,offsetX:0,offsetY:0,width:1,height:1}),this.view.enabled=!0,this.view.fullWidth=e,this.view.fullHeight=t,this.view.offsetX=n,this.view.offsetY=s,this.view.width=r,this.view.height=o,this.updateProjectionMatrix()}clearViewOffset(){this.view!==null&&(this.view.enabled=!1),this.updateProjectionMatrix()}updateProjectionMatrix(){let e=(this.right-this.left)/(2*this.zoom),t=(this.top-this.bottom)/(2*this.zoom),n=(this.right+this.left)/2,s=(this.top+this.bottom)/2,r=n-e,o=n+e,a=s+t,l=s-t;if(this.view!==null&&this.view.enabled){let c=(this.right-this.left)/this.view.fullWidth/this.zoom,h=(this.top-this.bottom)/this.view.fullHeight/this.zoom;r+=c*this.view.offsetX,o=r+c*this.view.width,a-=h*this.view.offsetY,l=a-h*this.view.height}this.projectionMatrix.makeOrthographic(r,o,a,l,this.near,this.far,this.coordinateSystem,this.reversedDepth),this.projectionMatrixInverse.copy(this.projectionMatrix).invert()}toJSON(e){let t=super.toJSON(e);return t.object.zoom=this.zoom,t.object.left=this.left,t.object.right=this.right,t.object.top=this.top,t.object.bottom=this.bottom,t.object.near=this.near,t.object.far=this.far,this.view!==null&&(t.object.view=Object.assign({},this.view)),t}};var Ji=-90,Ki=1,as=class extends $t{constructor(e,t,n){super(),this.type="CubeCamera",this.renderTarget=n,this.coordinateSystem=null,this.activeMipmapLevel=0;let s=new Gt(Ji,Ki,e,t);s.layers=this.layers,this.add(s);let r=new Gt(Ji,Ki,e,t);r.layers=this.layers,this.add(r);let o=new Gt(Ji,Ki,e,t);o.layers=this.layers,this.add(o);let a=new Gt(Ji,Ki,e,t);a.layers=this.layers,this.add(a);let l=new Gt(Ji,Ki,e,t);l.layers=this.layers,this.add(l);let c=new Gt(Ji,Ki,e,t);c.layers=this.layers,this.add(c)}updateCoordinateSystem(){let e=this.coordinateSystem,t=this.children.concat(),[n,s,r,o,a,l]=t;for(let c of t)this.remove(c);if(e===hn)n.up.set(0,1,0),n.lookAt(1,0,0),s.up.set(0,1,0),s.lookAt(-1,0,0),r.up.set(0,0,-1),r.lookAt(0,1,0),o.up.set(0,0,1),o.lookAt(0,-1,0),a.up.set(0,1,0),a.lookAt(0,0,1),l.up.set(0,1,0),l.lookAt(0,0,-1);else if(e===Ns)n.up.set(0,-1,0),n.lookAt(-1,0,0),s.up.set(0,-1,0),s.lookAt(1,0,0),r.up.set(0,0,1),r.lookAt(0,1,0),o.up.set(0,0,-1),o.lookAt(0,-1,0),a.up.set(0,-1,0),a.lookAt(0,0,1),l.up.set(0,-1,0),l.lookAt(0,0,-1);else throw new Error("THREE.CubeCamera.updateCoordinateSystem(): Invalid coordinate system: "+e);for(let c of t)this.add(c),c.updateMatrixWorld()}update(e,t){this.parent===null&&this.updateMatrixWorld();let{renderTarget:n,activeMipmapLevel:s}=this;this.coordinateSystem!==e.coordinateSystem&&(this.coordinateSystem=e.coordinateSystem,this.updateCoordinateSystem());let[r,o,a,l,c,h]=this.children,d=e.getRenderTarget(),u=e.getActiveCubeFace(),f=e.getActiveMipmapLevel(),v=e.xr.enabled;e.xr.enabled=!1;let S=n.texture.mipmapsAutoUpdate;n.texture.mipmapsAutoUpdate=!1;let m=!1;e.isWebGLRenderer===!0?m=e.state.buffers.depth.getReversed():m=e.reversedDepthBuffer,e.setRenderTarget(n,0,s),m&&e.autoClear===!1&&e.clearDepth(),e.render(t,r),e.setRenderTarget(n,1,s),m&&e.autoClear===!1&&e.clearDepth(),e.render(t,o),e.setRenderTarget(n,2,s),m&&e.autoClear===!1&&e.clearDepth(),e.render(t,a),e.setRenderTarget(n,3,s),m&&e.autoClear===!1&&e.clearDepth(),e.render(t,l),e.setRenderTarget(n,4,s),m&&e.autoClear===!1&&e.clearDepth(),e.render(t,c),n.texture.mipmapsAutoUpdate=S,e.setRenderTarget(n,5,s),m&&e.autoClear===!1&&e.clearDepth(),e.render(t,h),e.setRenderTarget(d,u,f),e.xr.enabled=v,n.texture.needsPMREMUpdate=!0}},Ao=class extends Gt{constructor(e=[]){super(),this.isArrayCamera=!0,this.isMultiViewCamera=!1,this.cameras=e,this.perCameraFrustumCulled=!1}};var Xl="\\[\\]\\.:\\/",Jf=new RegExp("["+Xl+"]","g"),ql="[^"+Xl+"]",Kf="[^"+Xl.replace("\\.","")+"]",Qf=/((?:WC+[\/:])*)/.source.replace("WC",ql),ep=/(WCOD+)?/.source.replace("WCOD",Kf),tp=/(?:\.(WC+)(?:\[(.+)\])?)?/.source.replace("WC",ql),np=/\.(WC+)(?:\[(.+)\])?/.source.replace("WC",ql),ip=new RegExp("^"+Qf+ep+tp+np+"$"),sp=["material","materials","bones","map"],ul=class{constructor(e,t,n){let s=n||rt.parseTrackName(t);this.Mt=e,this.I=e.subscribe_(t,s)}getValue(e,t){this.bind();let n=this.Mt.nCachedObjects_,s=this.I[n];s!==void 0&&s.getValue(e,t)}setValue(e,t){let n=this.I;for(let s=this.Mt.nCachedObjects_,r=n.length;s!==r;++s)n[s].setValue(e,t)}bind(){let e=this.I;for(let t=this.Mt.nCachedObjects_,n=e.length;t!==n;++t)e[t].bind()}unbind(){let e=this.I;for(let t=this.Mt.nCachedObjects_,n=e.length;t!==n;++t)e[t].unbind()}},rt=class i{constructor(e,t,n){this.path=t,this.parsedPath=n||i.parseTrackName(t),this.node=i.findNode(e,this.parsedPath.nodeName),this.rootNode=e,this.getValue=this.Hn,this.setValue=this.Wn}static create(e,t,n){return e&&e.isAnimationObjectGroup?new i.Composite(e,t,n):new i(e,t,n)}static sanitizeNodeName(e){return e.replace(/\s/g,"_").replace(Jf,"")}static parseTrackName(e){let t=ip.exec(e);if(t===null)throw new Error("THREE.PropertyBinding: Cannot parse trackName: "+e);let n={nodeName:t[2],objectName:t[3],objectIndex:t[4],propertyName:t[5],propertyIndex:t[6]},s=n.nodeName&&n.nodeName.lastIndexOf(".");if(s!==void 0&&s!==-1){let r=n.nodeName.substring(s+1);sp.indexOf(r)!==-1&&(n.nodeName=n.nodeName.substring(0,s),n.objectName=r)}if(n.propertyName===null||n.propertyName.length===0)throw new Error("THREE.PropertyBinding: can not parse propertyName from trackName: "+e);return n}static findNode(e,t){if(t===void 0||t===""||t==="."||t===-1||t===e.name||t===e.uuid)return e;if(e.skeleton){let n=e.skeleton.getBoneByName(t);if(n!==void 0)return n}if(e.children){let n=function(r){for(let o=0;o<r.length;o++){let a=r[o];if(a.name===t||a.uuid===t)return a;let l=n(a.children);if(l)return l}return null},s=n(e.children);if(s)return s}return null}Qi(){}es(){}ts(e,t){e[t]=this.targetObject[this.propertyName]}ns(e,t){let n=this.resolvedProperty;for(let s=0,r=n.length;s!==r;++s)e[t++]=n[s]}is(e,t){e[t]=this.resolvedProperty[this.propertyIndex]}ss(e,t){this.resolvedProperty.toArray(e,t)}rs(e,t){this.targetObject[this.propertyName]=e[t]}os(e,t){this.targetObject[this.propertyName]=e[t],this.targetObject.needsUpdate=!0}as(e,t){this.targetObject[this.propertyName]=e[t],this.targetObject.matrixWorldNeedsUpdate=!0}ls(e,t){let n=this.resolvedProperty;for(let s=0,r=n.length;s!==r;++s)n[s]=e[t++]}cs(e,t){let n=this.resolvedProperty;for(let s=0,r=n.length;s!==r;++s)n[s]=e[t++];this.targetObject.needsUpdate=!0}hs(e,t){let n=this.resolvedProperty;for(let s=0,r=n.length;s!==r;++s)n[s]=e[t++];this.targetObject.matrixWorldNeedsUpdate=!0}us(e,t){this.resolvedProperty[this.propertyIndex]=e[t]}ds(e,t){this.resolvedProperty[this.propertyIndex]=e[t],this.targetObject.needsUpdate=!0}fs(e,t){this.resolvedProperty[this.propertyIndex]=e[t],this.targetObject.matrixWorldNeedsUpdate=!0}ps(e,t){this.resolvedProperty.fromArray(e,t)}ms(e,t){this.resolvedProperty.fromArray(e,t),this.targetObject.needsUpdate=!0}gs(e,t){this.resolvedProperty.fromArray(e,t),this.targetObject.matrixWorldNeedsUpdate=!0}Hn(e,t){this.bind(),this.getValue(e,t)}Wn(e,t){this.bind(),this.setValue(e,t)}bind(){let e=this.node,t=this.parsedPath,n=t.objectName,s=t.propertyName,r=t.propertyIndex;if(e||(e=i.findNode(this.rootNode,t.nodeName),this.node=e),this.getValue=this.Qi,this.setValue=this.es,!e){Ce("PropertyBinding: No target node found for track: "+this.path+".");return}if(n){let c=t.objectIndex;switch(n){case"materials":if(!e.material){Ne("PropertyBinding: Can not bind to material as node does not have a material.",this);return}if(!e.material.materials){Ne("PropertyBinding: Can not bind to material.materials as node.material does not have a materials array.",this);return}e=e.material.materials;break;case"bones":if(!e.skeleton){Ne("PropertyBinding: Can not bind to bones as node does not have a skeleton.",this);return}e=e.skeleton.bones;for(let h=0;h<e.length;h++)if(e[h].name===c){c=h;break}break;case"map":if("map"in e){e=e.map;break}if(!e.material){Ne("PropertyBinding: Can not bind to material as node does not have a material.",this);return}if(!e.material.map){Ne("PropertyBinding: Can not bind to material.map as node.material does not have a map.",this);return}e=e.material.map;break;default:if(e[n]===void 0){Ne("PropertyBinding: Can not bind to objectName of node undefined.",this);return}e=e[n]}if(c!==void 0){if(e[c]===void 0){Ne("PropertyBinding: Trying to bind to objectIndex of objectName, but is undefined.",this,e);return}e=e[c]}}let o=e[s];if(o===void 0){let c=t.nodeName;Ne("PropertyBinding: Trying to update property for track: "+c+"."+s+" but it wasn't found.",e);return}let a=this.Versioning.None;this.targetObject=e,e.isMaterial===!0?a=this.Versioning.NeedsUpdate:e.isObject3D===!0&&(a=this.Versioning.MatrixWorldNeedsUpdate);let l=this.BindingType.Direct;if(r!==void 0){if(s==="morphTargetInfluences"){if(!e.geometry){Ne("PropertyBinding: Can not bind to morphTargetInfluences because node does not have a geometry.",this);return}if(!e.geometry.morphAttributes){Ne("PropertyBinding: Can not bind to morphTargetInfluences because node does not have a geometry.morphAttributes.",this);return}e.morphTargetDictionary[r]!==void 0&&(r=e.morphTargetDictionary[r])}l=this.BindingType.ArrayElement,this.resolvedProperty=o,this.propertyIndex=r}else o.fromArray!==void 0&&o.toArray!==void 0?(l=this.BindingType.HasFromToArray,this.resolvedProperty=o):Array.isArray(o)?(l=this.BindingType.EntireArray,this.resolvedProperty=o):this.propertyName=s;this.getValue=this.GetterByBindingType[l],this.setValue=this.SetterByBindingTypeAndVersioning[l][a]}unbind(){this.node=null,this.getValue=this.Hn,this.setValue=this.Wn}};rt.Composite=ul;rt.prototype.BindingType={Direct:0,EntireArray:1,ArrayElement:2,HasFromToArray:3};rt.prototype.Versioning={None:0,NeedsUpdate:1,MatrixWorldNeedsUpdate:2};rt.prototype.GetterByBindingType=[rt.prototype.ts,rt.prototype.ns,rt.prototype.is,rt.prototype.ss];rt.prototype.SetterByBindingTypeAndVersioning=[[rt.prototype.rs,rt.prototype.os,rt.prototype.as],[rt.prototype.ls,rt.prototype.cs,rt.prototype.hs],[rt.prototype.us,rt.prototype.ds,rt.prototype.fs],[rt.prototype.ps,rt.prototype.ms,rt.prototype.gs]];var Wy=new Float32Array(1);var ls=class{constructor(e=1,t=0,n=0){this.radius=e,this.phi=t,this.theta=n}set(e,t,n){return this.radius=e,this.phi=t,this.theta=n,this}copy(e){return this.radius=e.radius,this.phi=e.phi,this.theta=e.theta,this}makeSafe(){return this.phi=He(this.phi,1e-6,Math.PI-1e-6),this}setFromVector3(e){return this.setFromCartesianCoords(e.x,e.y,e.z)}setFromCartesianCoords(e,t,n){return this.radius=Math.sqrt(e*e+t*t+n*n),this.radius===0?(this.theta=0,this.phi=0):(this.theta=Math.atan2(e,n),this.phi=Math.acos(He(t/this.radius,-1,1))),this}clone(){return new this.constructor().copy(this)}};var dl=class{static{this.prototype.isMatrix2=!0}constructor(e,t,n,s){this.elements=[1,0,0,1],e!==void 0&&this.set(e,t,n,s)}identity(){return this.set(1,0,0,1),this}fromArray(e,t=0){for(let n=0;n<4;n++)this.elements[n]=e[n+t];return this}set(e,t,n,s){let r=this.elements;return r[0]=e,r[2]=t,r[1]=n,r[3]=s,this}};var $s=class extends xn{constructor(e,t=null){super(),this.object=e,this.domElement=t,this.enabled=!0,this.state=-1,this.keys={},this.mouseButtons={LEFT:null,MIDDLE:null,RIGHT:null},this.touches={ONE:null,TWO:null}}connect(e){this.domElement!==null&&this.disconnect(),this.domElement=e}disconnect(){}dispose(){}update(){}};function Yl(i,e,t,n){let s=rp(n);switch(t){case Il:return i*e;case Dl:return i*e/s.components*s.byteLength;case No:return i*e/s.components*s.byteLength;case xi:return i*e*2/s.components*s.byteLength;case Do:return i*e*2/s.components*s.byteLength;case Nl:return i*e*3/s.components*s.byteLength;case bn:return i*e*4/s.components*s.byteLength;case Uo:return i*e*4/s.components*s.byteLength;case Js:case Ks:return Math.floor((i+3)/4)*Math.floor((e+3)/4)*8;case Qs:case er:return Math.floor((i+3)/4)*Math.floor((e+3)/4)*16;case Fo:case ko:return Math.max(i,16)*Math.max(e,8)/4;case Oo:case Bo:return Math.max(i,8)*Math.max(e,8)/2;case zo:case Go:case Ho:case Wo:return Math.floor((i+3)/4)*Math.floor((e+3)/4)*8;case Vo:case tr:case Xo:return Math.floor((i+3)/4)*Math.floor((e+3)/4)*16;case qo:return Math.floor((i+3)/4)*Math.floor((e+3)/4)*16;case Yo:return Math.floor((i+4)/5)*Math.floor((e+3)/4)*16;case $o:return Math.floor((i+4)/5)*Math.floor((e+4)/5)*16;case Zo:return Math.floor((i+5)/6)*Math.floor((e+4)/5)*16;case jo:return Math.floor((i+5)/6)*Math.floor((e+5)/6)*16;case Jo:return Math.floor((i+7)/8)*Math.floor((e+4)/5)*16;case Ko:return Math.floor((i+7)/8)*Math.floor((e+5)/6)*16;case Qo:return Math.floor((i+7)/8)*Math.floor((e+7)/8)*16;case ea:return Math.floor((i+9)/10)*Math.floor((e+4)/5)*16;case ta:return Math.floor((i+9)/10)*Math.floor((e+5)/6)*16;case na:return Math.floor((i+9)/10)*Math.floor((e+7)/8)*16;case ia:return Math.floor((i+9)/10)*Math.floor((e+9)/10)*16;case sa:return Math.floor((i+11)/12)*Math.floor((e+9)/10)*16;case ra:return Math.floor((i+11)/12)*Math.floor((e+11)/12)*16;case oa:case aa:case la:return Math.ceil(i/4)*Math.ceil(e/4)*16;case ca:case ha:return Math.ceil(i/4)*Math.ceil(e/4)*8;case nr:case ua:return Math.ceil(i/4)*Math.ceil(e/4)*16}throw new Error(`Unable to determine texture byte length for ${t} format.`)}function rp(i){switch(i){case sn:case Rl:return{byteLength:1,components:1};case ds:case Cl:case Mn:return{byteLength:2,components:1};case Lo:case Io:return{byteLength:2,components:4};case yn:case Po:case Sn:return{byteLength:4,components:1};case Pl:case Ll:return{byteLength:4,components:3}}throw new Error(`THREE.TextureUtils: Unknown texture type ${i}.`)}typeof window<"u"&&(window.Rs?Ce("WARNING: Multiple instances of Three.js being imported."):window.Rs="187");function Du(){let i=null,e=!1,t=null,n=null;function s(r,o){n=i.requestAnimationFrame(s),t(r,o)}return{start:function(){e!==!0&&t!==null&&i!==null&&(n=i.requestAnimationFrame(s),e=!0)},stop:function(){i!==null&&i.cancelAnimationFrame(n),e=!1},setAnimationLoop:function(r){t=r},setContext:function(r){i=r}}}function ap(i){let e=new WeakMap;function t(a,l){let c=a.array,h=a.usage,d=c.byteLength,u=i.createBuffer();i.bindBuffer(l,u),i.bufferData(l,c,h),a.onUploadCallback();let f;if(c instanceof Float32Array)f=i.FLOAT;else if(typeof Float16Array<"u"&&c instanceof Float16Array)f=i.HALF_FLOAT;else if(c instanceof Uint16Array)a.isFloat16BufferAttribute?f=i.HALF_FLOAT:f=i.UNSIGNED_SHORT;else if(c instanceof Int16Array)f=i.SHORT;else if(c instanceof Uint32Array)f=i.UNSIGNED_INT;else if(c instanceof Int32Array)f=i.INT;else if(c instanceof Int8Array)f=i.BYTE;else if(c instanceof Uint8Array)f=i.UNSIGNED_BYTE;else if(c instanceof Uint8ClampedArray)f=i.UNSIGNED_BYTE;else throw new Error("THREE.WebGLAttributes: Unsupported buffer data format: "+c);return{buffer:u,type:f,bytesPerElement:c.BYTES_PER_ELEMENT,version:a.version,size:d}}function n(a,l,c){let h=l.array,d=l.updateRanges;if(i.bindBuffer(c,a),d.length===0)i.bufferSubData(c,0,h);else{d.sort((f,v)=>f.start-v.start);let u=0;for(let f=1;f<d.length;f++){let v=d[u],S=d[f];S.start<=v.start+v.count+1?v.count=Math.max(v.count,S.start+S.count-v.start):(++u,d[u]=S)}d.length=u+1;for(let f=0,v=d.length;f<v;f++){let S=d[f];i.bufferSubData(c,S.start*h.BYTES_PER_ELEMENT,h,S.start,S.count)}l.clearUpdateRanges()}l.onUploadCallback()}function s(a){return a.isInterleavedBufferAttribute&&(a=a.data),e.get(a)}function r(a){a.isInterleavedBufferAttribute&&(a=a.data);let l=e.get(a);l&&(i.deleteBuffer(l.buffer),e.delete(a))}function o(a,l){if(a.isInterleavedBufferAttribute&&(a=a.data),a.isGLBufferAttribute){let h=e.get(a);(!h||h.version<a.version)&&e.set(a,{buffer:a.buffer,type:a.type,bytesPerElement:a.elementSize,version:a.version});return}let c=e.get(a);if(c===void 0)e.set(a,t(a,l));else if(c.version<a.version){if(c.size!==a.array.byteLength)throw new Error("THREE.WebGLAttributes: The size of the buffer attribute's array buffer does not match the original size. Resizing buffer attributes is not supported.");n(c.buffer,a,l),c.version=a.version}}return{get:s,remove:r,update:o}}var lp=`#ifdef USE_ALPHAHASH
if ( diffuseColor.a < getAlphaHashThreshold( vPosition ) ) discard;
#endif`,cp=`#ifdef USE_ALPHAHASH
const float ALPHA_HASH_SCALE = 0.05;
float hash2D( vec2 value ) {
return fract( 1.0e4 * sin( 17.0 * value.x + 0.1 * value.y ) * ( 0.1 + abs( sin( 13.0 * value.y + value.x ) ) ) );
}
float hash3D( vec3 value ) {
return hash2D( vec2( hash2D( value.xy ), value.z ) );
}
float getAlphaHashThreshold( vec3 position ) {
float maxDeriv = max(
length( dFdx( position.xyz ) ),
length( dFdy( position.xyz ) )
);
float pixScale = 1.0 / ( ALPHA_HASH_SCALE * maxDeriv );
vec2 pixScales = vec2(
exp2( floor( log2( pixScale ) ) ),
exp2( ceil( log2( pixScale ) ) )
);
vec2 alpha = vec2(
hash3D( floor( pixScales.x * position.xyz ) ),
hash3D( floor( pixScales.y * position.xyz ) )
);
float lerpFactor = fract( log2( pixScale ) );
float x = ( 1.0 - lerpFactor ) * alpha.x + lerpFactor * alpha.y;
float a = min( lerpFactor, 1.0 - lerpFactor );
vec3 cases = vec3(
x * x / ( 2.0 * a * ( 1.0 - a ) ),
( x - 0.5 * a ) / ( 1.0 - a ),
1.0 - ( ( 1.0 - x ) * ( 1.0 - x ) / ( 2.0 * a * ( 1.0 - a ) ) )
);
float threshold = ( x < ( 1.0 - a ) )
? ( ( x < a ) ? cases.x : cases.y )
: cases.z;
return clamp( threshold , 1.0e-6, 1.0 );
}
#endif`,hp=`#ifdef USE_ALPHAMAP
diffuseColor.a *= texture2D( alphaMap, vAlphaMapUv ).g;
#endif`,up=`#ifdef USE_ALPHAMAP
uniform sampler2D alphaMap;
#endif`,dp=`#ifdef USE_ALPHATEST
#ifdef ALPHA_TO_COVERAGE
diffuseColor.a = smoothstep( alphaTest, alphaTest + fwidth( diffuseColor.a ), diffuseColor.a );
if ( diffuseColor.a == 0.0 ) discard;
#else
if ( diffuseColor.a < alphaTest ) discard;
#endif
#endif`,fp=`#ifdef USE_ALPHATEST
uniform float alphaTest;
#endif`,pp=`#ifdef USE_AOMAP
float ambientOcclusion = ( texture2D( aoMap, vAoMapUv ).r - 1.0 ) * aoMapIntensity + 1.0;
reflectedLight.indirectDiffuse *= ambientOcclusion;
#if defined( USE_CLEARCOAT ) 
clearcoatSpecularIndirect *= ambientOcclusion;
#endif
#if defined( USE_SHEEN ) 
sheenSpecularIndirect *= ambientOcclusion;
#endif
#if defined( USE_ENVMAP ) && defined( STANDARD )
float dotNV = saturate( dot( geometryNormal, geometryViewDir ) );
reflectedLight.indirectSpecular *= computeSpecularOcclusion( dotNV, ambientOcclusion, material.roughness );
#endif
#endif`,mp=`#ifdef USE_AOMAP
uniform sampler2D aoMap;
uniform float aoMapIntensity;
#endif`,gp=`#ifdef USE_BATCHING
#if ! defined( GL_ANGLE_multi_draw )
#define gl_DrawID _gl_DrawID
uniform int _gl_DrawID;
#endif
uniform highp sampler2D batchingTexture;
uniform highp usampler2D batchingIdTexture;
mat4 getBatchingMatrix( const in float i ) {
int size = textureSize( batchingTexture, 0 ).x;
int j = int( i ) * 4;
int x = j % size;
int y = j / size;
vec4 v1 = texelFetch( batchingTexture, ivec2( x, y ), 0 );
vec4 v2 = texelFetch( batchingTexture, ivec2( x + 1, y ), 0 );
vec4 v3 = texelFetch( batchingTexture, ivec2( x + 2, y ), 0 );
vec4 v4 = texelFetch( batchingTexture, ivec2( x + 3, y ), 0 );
return mat4( v1, v2, v3, v4 );
}
float getIndirectIndex( const in int i ) {
int size = textureSize( batchingIdTexture, 0 ).x;
int x = i % size;
int y = i / size;
return float( texelFetch( batchingIdTexture, ivec2( x, y ), 0 ).r );
}
#endif
#ifdef USE_BATCHING_COLOR
uniform sampler2D batchingColorTexture;
vec4 getBatchingColor( const in float i ) {
int size = textureSize( batchingColorTexture, 0 ).x;
int j = int( i );
int x = j % size;
int y = j / size;
return texelFetch( batchingColorTexture, ivec2( x, y ), 0 );
}
#endif`,vp=`#ifdef USE_BATCHING
mat4 batchingMatrix = getBatchingMatrix( getIndirectIndex( gl_DrawID ) );
#endif`,xp=`vec3 transformed = vec3( position );
#ifdef USE_ALPHAHASH
vPosition = vec3( position );
#endif`,yp=`vec3 objectNormal = vec3( normal );
#ifdef USE_TANGENT
vec3 objectTangent = vec3( tangent.xyz );
#endif`,Sp=`float G_BlinnPhong_Implicit( ) {
return 0.25;
}
float D_BlinnPhong( const in float shininess, const in float dotNH ) {
return RECIPROCAL_PI * ( shininess * 0.5 + 1.0 ) * pow( dotNH, shininess );
}
vec3 BRDF_BlinnPhong( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in vec3 specularColor, const in float shininess ) {
vec3 halfDir = normalize( lightDir + viewDir );
float dotNH = saturate( dot( normal, halfDir ) );
float dotVH = saturate( dot( viewDir, halfDir ) );
vec3 F = F_Schlick( specularColor, 1.0, dotVH );
float G = G_BlinnPhong_Implicit( );
float D = D_BlinnPhong( shininess, dotNH );
return F * ( G * D );
} // validated`,Mp=`#ifdef USE_IRIDESCENCE
const mat3 XYZ_TO_REC709 = mat3(
 3.2404542, -0.9692660,  0.0556434,
-1.5371385,  1.8760108, -0.2040259,
-0.4985314,  0.0415560,  1.0572252
);
vec3 Fresnel0ToIor( vec3 fresnel0 ) {
vec3 sqrtF0 = sqrt( fresnel0 );
return ( vec3( 1.0 ) + sqrtF0 ) / ( vec3( 1.0 ) - sqrtF0 );
}
vec3 IorToFresnel0( vec3 transmittedIor, float incidentIor ) {
return pow2( ( transmittedIor - vec3( incidentIor ) ) / ( transmittedIor + vec3( incidentIor ) ) );
}
float IorToFresnel0( float transmittedIor, float incidentIor ) {
return pow2( ( transmittedIor - incidentIor ) / ( transmittedIor + incidentIor ));
}
vec3 evalSensitivity( float OPD, vec3 shift ) {
float phase = 2.0 * PI * OPD * 1.0e-9;
vec3 val = vec3( 5.4856e-13, 4.4201e-13, 5.2481e-13 );
vec3 pos = vec3( 1.6810e+06, 1.7953e+06, 2.2084e+06 );
vec3 var = vec3( 4.3278e+09, 9.3046e+09, 6.6121e+09 );
vec3 xyz = val * sqrt( 2.0 * PI * var ) * cos( pos * phase + shift ) * exp( - pow2( phase ) * var );
xyz.x += 9.7470e-14 * sqrt( 2.0 * PI * 4.5282e+09 ) * cos( 2.2399e+06 * phase + shift[ 0 ] ) * exp( - 4.5282e+09 * pow2( phase ) );
xyz /= 1.0685e-7;
vec3 rgb = XYZ_TO_REC709 * xyz;
return rgb;
}
vec3 evalIridescence( float outsideIOR, float eta2, float cosTheta1, float thinFilmThickness, vec3 baseF0 ) {
vec3 I;
float iridescenceIOR = mix( outsideIOR, eta2, smoothstep( 0.0, 0.03, thinFilmThickness ) );
float sinTheta2Sq = pow2( outsideIOR / iridescenceIOR ) * ( 1.0 - pow2( cosTheta1 ) );
float cosTheta2Sq = 1.0 - sinTheta2Sq;
if ( cosTheta2Sq < 0.0 ) {
return vec3( 1.0 );
}
float cosTheta2 = sqrt( cosTheta2Sq );
float R0 = IorToFresnel0( iridescenceIOR, outsideIOR );
float R12 = F_Schlick( R0, 1.0, cosTheta1 );
float T121 = 1.0 - R12;
float phi12 = 0.0;
if ( iridescenceIOR < outsideIOR ) phi12 = PI;
float phi21 = PI - phi12;
vec3 baseIOR = Fresnel0ToIor( clamp( baseF0, 0.0, 0.9999 ) );		vec3 R1 = IorToFresnel0( baseIOR, iridescenceIOR );
vec3 R23 = F_Schlick( R1, 1.0, cosTheta2 );
vec3 phi23 = vec3( 0.0 );
if ( baseIOR[ 0 ] < iridescenceIOR ) phi23[ 0 ] = PI;
if ( baseIOR[ 1 ] < iridescenceIOR ) phi23[ 1 ] = PI;
if ( baseIOR[ 2 ] < iridescenceIOR ) phi23[ 2 ] = PI;
float OPD = 2.0 * iridescenceIOR * thinFilmThickness * cosTheta2;
vec3 phi = vec3( phi21 ) + phi23;
vec3 R123 = clamp( R12 * R23, 1e-5, 0.9999 );
vec3 r123 = sqrt( R123 );
vec3 Rs = pow2( T121 ) * R23 / ( vec3( 1.0 ) - R123 );
vec3 C0 = R12 + Rs;
I = C0;
vec3 Cm = Rs - T121;
for ( int m = 1; m <= 2; ++ m ) {
Cm *= r123;
vec3 Sm = 2.0 * evalSensitivity( float( m ) * OPD, float( m ) * phi );
I += Cm * Sm;
}
return max( I, vec3( 0.0 ) );
}
#endif`,bp=`#ifdef USE_BUMPMAP
uniform sampler2D bumpMap;
uniform float bumpScale;
vec2 dHdxy_fwd() {
vec2 dSTdx = dFdx( vBumpMapUv );
vec2 dSTdy = dFdy( vBumpMapUv );
float Hll = bumpScale * texture2D( bumpMap, vBumpMapUv ).x;
float dBx = bumpScale * texture2D( bumpMap, vBumpMapUv + dSTdx ).x - Hll;
float dBy = bumpScale * texture2D( bumpMap, vBumpMapUv + dSTdy ).x - Hll;
return vec2( dBx, dBy );
}
vec3 perturbNormalArb( vec3 surf_pos, vec3 surf_norm, vec2 dHdxy, float faceDirection ) {
vec3 vSigmaX = normalize( dFdx( surf_pos.xyz ) );
vec3 vSigmaY = normalize( dFdy( surf_pos.xyz ) );
vec3 vN = surf_norm;
vec3 R1 = cross( vSigmaY, vN );
vec3 R2 = cross( vN, vSigmaX );
float fDet = dot( vSigmaX, R1 ) * faceDirection;
vec3 vGrad = sign( fDet ) * ( dHdxy.x * R1 + dHdxy.y * R2 );
return normalize( abs( fDet ) * surf_norm - vGrad );
}
#endif`,_p=`#if NUM_CLIPPING_PLANES > 0
vec4 plane;
#ifdef ALPHA_TO_COVERAGE
float distanceToPlane, distanceGradient;
float clipOpacity = 1.0;
#pragma unroll_loop_start
for ( int i = 0; i < UNION_CLIPPING_PLANES; i ++ ) {
plane = clippingPlanes[ i ];
distanceToPlane = - dot( vClipPosition, plane.xyz ) + plane.w;
distanceGradient = fwidth( distanceToPlane ) / 2.0;
clipOpacity *= smoothstep( - distanceGradient, distanceGradient, distanceToPlane );
if ( clipOpacity == 0.0 ) discard;
}
#pragma unroll_loop_end
#if UNION_CLIPPING_PLANES < NUM_CLIPPING_PLANES
float unionClipOpacity = 1.0;
#pragma unroll_loop_start
for ( int i = UNION_CLIPPING_PLANES; i < NUM_CLIPPING_PLANES; i ++ ) {
plane = clippingPlanes[ i ];
distanceToPlane = - dot( vClipPosition, plane.xyz ) + plane.w;
distanceGradient = fwidth( distanceToPlane ) / 2.0;
unionClipOpacity *= 1.0 - smoothstep( - distanceGradient, distanceGradient, distanceToPlane );
}
#pragma unroll_loop_end
clipOpacity *= 1.0 - unionClipOpacity;
#endif
diffuseColor.a *= clipOpacity;
if ( diffuseColor.a == 0.0 ) discard;
#else
#pragma unroll_loop_start
for ( int i = 0; i < UNION_CLIPPING_PLANES; i ++ ) {
plane = clippingPlanes[ i ];
if ( dot( vClipPosition, plane.xyz ) > plane.w ) discard;
}
#pragma unroll_loop_end
#if UNION_CLIPPING_PLANES < NUM_CLIPPING_PLANES
bool clipped = true;
#pragma unroll_loop_start
for ( int i = UNION_CLIPPING_PLANES; i < NUM_CLIPPING_PLANES; i ++ ) {
plane = clippingPlanes[ i ];
clipped = ( dot( vClipPosition, plane.xyz ) > plane.w ) && clipped;
}
#pragma unroll_loop_end
if ( clipped ) discard;
#endif
#endif
#endif`,wp=`#if NUM_CLIPPING_PLANES > 0
varying vec3 vClipPosition;
uniform vec4 clippingPlanes[ NUM_CLIPPING_PLANES ];
#endif`,Ep=`#if NUM_CLIPPING_PLANES > 0
varying vec3 vClipPosition;
#endif`,Ap=`#if NUM_CLIPPING_PLANES > 0
vClipPosition = - mvPosition.xyz;
#endif`,Tp=`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA )
diffuseColor *= vColor;
#endif`,Rp=`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA )
varying vec4 vColor;
#endif`,Cp=`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA ) || defined( USE_INSTANCING_COLOR ) || defined( USE_BATCHING_COLOR )
varying vec4 vColor;
#endif`,Pp=`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA ) || defined( USE_INSTANCING_COLOR ) || defined( USE_BATCHING_COLOR )
vColor = vec4( 1.0 );
#endif
#ifdef USE_COLOR_ALPHA
vColor *= color;
#elif defined( USE_COLOR )
vColor.rgb *= color;
#endif
#ifdef USE_INSTANCING_COLOR
vColor.rgb *= instanceColor.rgb;
#endif
#ifdef USE_BATCHING_COLOR
vColor *= getBatchingColor( getIndirectIndex( gl_DrawID ) );
#endif`,Lp=`#define PI 3.141592653589793
#define PI2 6.283185307179586
#define PI_HALF 1.5707963267948966
#define RECIPROCAL_PI 0.3183098861837907
#define RECIPROCAL_PI2 0.15915494309189535
#define EPSILON 1e-6
#ifndef saturate
#define saturate( a ) clamp( a, 0.0, 1.0 )
#endif
#define whiteComplement( a ) ( 1.0 - saturate( a ) )
float pow2( const in float x ) { return x*x; }
vec3 pow2( const in vec3 x ) { return x*x; }
float pow3( const in float x ) { return x*x*x; }
float pow4( const in float x ) { float x2 = x*x; return x2*x2; }
float max3( const in vec3 v ) { return max( max( v.x, v.y ), v.z ); }
float average( const in vec3 v ) { return dot( v, vec3( 0.3333333 ) ); }
highp float rand( const in vec2 uv ) {
const highp float a = 12.9898, b = 78.233, c = 43758.5453;
highp float dt = dot( uv.xy, vec2( a,b ) ), sn = mod( dt, PI );
return fract( sin( sn ) * c );
}
#ifdef HIGH_PRECISION
float precisionSafeLength( vec3 v ) { return length( v ); }
#else
float precisionSafeLength( vec3 v ) {
float maxComponent = max3( abs( v ) );
return length( v / maxComponent ) * maxComponent;
}
#endif
struct IncidentLight {
vec3 color;
vec3 direction;
bool visible;
};
struct ReflectedLight {
vec3 directDiffuse;
vec3 directSpecular;
vec3 indirectDiffuse;
vec3 indirectSpecular;
};
#ifdef USE_ALPHAHASH
varying vec3 vPosition;
#endif
vec3 transformDirection( in vec3 dir, in mat4 matrix ) {
return normalize( ( matrix * vec4( dir, 0.0 ) ).xyz );
}
#define inverseTransformDirection transformDirectionByInverseViewMatrix
vec3 transformNormalByInverseViewMatrix( in vec3 normal, in mat4 viewMatrix ) {
return normalize( ( vec4( normal, 0.0 ) * viewMatrix ).xyz );
}
vec3 transformDirectionByInverseViewMatrix( in vec3 dir, in mat4 viewMatrix ) {
return normalize( ( vec4( dir, 0.0 ) * viewMatrix ).xyz );
}
bool isPerspectiveMatrix( mat4 m ) {
return m[ 2 ][ 3 ] == - 1.0;
}
vec2 equirectUv( in vec3 dir ) {
float u = atan( dir.z, dir.x ) * RECIPROCAL_PI2 + 0.5;
float v = asin( clamp( dir.y, - 1.0, 1.0 ) ) * RECIPROCAL_PI + 0.5;
return vec2( u, v );
}
vec3 BRDF_Lambert( const in vec3 diffuseColor ) {
return RECIPROCAL_PI * diffuseColor;
}
vec3 F_Schlick( const in vec3 f0, const in float f90, const in float dotVH ) {
float fresnel = exp2( ( - 5.55473 * dotVH - 6.98316 ) * dotVH );
return f0 * ( 1.0 - fresnel ) + ( f90 * fresnel );
}
float F_Schlick( const in float f0, const in float f90, const in float dotVH ) {
float fresnel = exp2( ( - 5.55473 * dotVH - 6.98316 ) * dotVH );
return f0 * ( 1.0 - fresnel ) + ( f90 * fresnel );
} // validated`,Ip=`vec3 transformedNormal = objectNormal;
#ifdef USE_TANGENT
vec3 transformedTangent = objectTangent;
#endif
#ifdef USE_BATCHING
mat3 bm = mat3( batchingMatrix );
transformedNormal /= vec3( dot( bm[ 0 ], bm[ 0 ] ), dot( bm[ 1 ], bm[ 1 ] ), dot( bm[ 2 ], bm[ 2 ] ) );
transformedNormal = bm * transformedNormal;
#ifdef USE_TANGENT
transformedTangent = bm * transformedTangent;
#endif
#endif
#ifdef USE_INSTANCING
mat3 im = mat3( instanceMatrix );
transformedNormal /= vec3( dot( im[ 0 ], im[ 0 ] ), dot( im[ 1 ], im[ 1 ] ), dot( im[ 2 ], im[ 2 ] ) );
transformedNormal = im * transformedNormal;
#ifdef USE_TANGENT
transformedTangent = im * transformedTangent;
#endif
#endif
transformedNormal = normalMatrix * transformedNormal;
#ifdef FLIP_SIDED
transformedNormal = - transformedNormal;
#endif
#ifdef USE_TANGENT
transformedTangent = ( modelViewMatrix * vec4( transformedTangent, 0.0 ) ).xyz;
#endif`,Np=`#ifdef USE_DISPLACEMENTMAP
uniform sampler2D displacementMap;
uniform float displacementScale;
uniform float displacementBias;
#endif`,Dp=`#ifdef USE_DISPLACEMENTMAP
transformed += normalize( objectNormal ) * ( texture2D( displacementMap, vDisplacementMapUv ).x * displacementScale + displacementBias );
#endif`,Up=`#ifdef USE_EMISSIVEMAP
vec4 emissiveColor = texture2D( emissiveMap, vEmissiveMapUv );
#ifdef DECODE_VIDEO_TEXTURE_EMISSIVE
emissiveColor = sRGBTransferEOTF( emissiveColor );
#endif
totalEmissiveRadiance *= emissiveColor.rgb;
#endif`,Op=`#ifdef USE_EMISSIVEMAP
uniform sampler2D emissiveMap;
#endif`,Fp="gl_FragColor = linearToOutputTexel( gl_FragColor );",Bp=`vec4 LinearTransferOETF( in vec4 value ) {
return value;
}
vec4 sRGBTransferEOTF( in vec4 value ) {
return vec4( mix( pow( value.rgb * 0.9478672986 + vec3( 0.0521327014 ), vec3( 2.4 ) ), value.rgb * 0.0773993808, vec3( lessThanEqual( value.rgb, vec3( 0.04045 ) ) ) ), value.a );
}
vec4 sRGBTransferOETF( in vec4 value ) {
return vec4( mix( pow( value.rgb, vec3( 0.41666 ) ) * 1.055 - vec3( 0.055 ), value.rgb * 12.92, vec3( lessThanEqual( value.rgb, vec3( 0.0031308 ) ) ) ), value.a );
}`,kp=`#ifdef USE_ENVMAP
#ifdef ENV_WORLDPOS
vec3 cameraToFrag;
if ( isOrthographic ) {
cameraToFrag = normalize( vec3( - viewMatrix[ 0 ][ 2 ], - viewMatrix[ 1 ][ 2 ], - viewMatrix[ 2 ][ 2 ] ) );
} else {
cameraToFrag = normalize( vWorldPosition - cameraPosition );
}
vec3 worldNormal = transformNormalByInverseViewMatrix( normal, viewMatrix );
#ifdef ENVMAP_MODE_REFLECTION
vec3 reflectVec = reflect( cameraToFrag, worldNormal );
#else
vec3 reflectVec = refract( cameraToFrag, worldNormal, refractionRatio );
#endif
#else
vec3 reflectVec = vReflect;
#endif
#ifdef ENVMAP_TYPE_CUBE
vec4 envColor = textureCube( envMap, envMapRotation * reflectVec );
#ifdef ENVMAP_BLENDING_MULTIPLY
outgoingLight = mix( outgoingLight, outgoingLight * envColor.xyz, specularStrength * reflectivity );
#elif defined( ENVMAP_BLENDING_MIX )
outgoingLight = mix( outgoingLight, envColor.xyz, specularStrength * reflectivity );
#elif defined( ENVMAP_BLENDING_ADD )
outgoingLight += envColor.xyz * specularStrength * reflectivity;
#endif
#endif
#endif`,zp=`#ifdef USE_ENVMAP
uniform float envMapIntensity;
uniform mat3 envMapRotation;
uniform samplerCube envMap;
#ifdef ENVMAP_TYPE_PMREM
float roughnessToMip( const in float roughness ) {
float r = clamp( roughness, 0.0, 1.0 );
return ENVMAP_MAX_LOD * r * ( 2.0 - r );
}
#endif
#endif`,Gp=`#ifdef USE_ENVMAP
uniform float reflectivity;
#if defined( USE_BUMPMAP ) || defined( USE_NORMALMAP ) || defined( PHONG ) || defined( LAMBERT )
#define ENV_WORLDPOS
#endif
#ifdef ENV_WORLDPOS
varying vec3 vWorldPosition;
uniform float refractionRatio;
#else
varying vec3 vReflect;
#endif
#endif`,Vp=`#ifdef USE_ENVMAP
#if defined( USE_BUMPMAP ) || defined( USE_NORMALMAP ) || defined( PHONG ) || defined( LAMBERT )
#define ENV_WORLDPOS
#endif
#ifdef ENV_WORLDPOS

varying vec3 vWorldPosition;
#else
varying vec3 vReflect;
uniform float refractionRatio;
#endif
#endif`,Hp=`#ifdef USE_ENVMAP
#ifdef ENV_WORLDPOS
vWorldPosition = worldPosition.xyz;
#else
vec3 cameraToVertex;
if ( isOrthographic ) {
cameraToVertex = normalize( vec3( - viewMatrix[ 0 ][ 2 ], - viewMatrix[ 1 ][ 2 ], - viewMatrix[ 2 ][ 2 ] ) );
} else {
cameraToVertex = normalize( worldPosition.xyz - cameraPosition );
}
vec3 worldNormal = transformNormalByInverseViewMatrix( transformedNormal, viewMatrix );
#ifdef ENVMAP_MODE_REFLECTION
vReflect = reflect( cameraToVertex, worldNormal );
#else
vReflect = refract( cameraToVertex, worldNormal, refractionRatio );
#endif
#endif
#endif`,Wp=`#ifdef USE_FOG
vFogDepth = - mvPosition.z;
#endif`,Xp=`#ifdef USE_FOG
varying float vFogDepth;
#endif`,qp=`#ifdef USE_FOG
#ifdef FOG_EXP2
float fogFactor = 1.0 - exp( - fogDensity * fogDensity * vFogDepth * vFogDepth );
#else
float fogFactor = smoothstep( fogNear, fogFar, vFogDepth );
#endif
gl_FragColor.rgb = mix( gl_FragColor.rgb, fogColor, fogFactor );
#endif`,Yp=`#ifdef USE_FOG
uniform vec3 fogColor;
varying float vFogDepth;
#ifdef FOG_EXP2
uniform float fogDensity;
#else
uniform float fogNear;
uniform float fogFar;
#endif
#endif`,$p=`#ifdef USE_GRADIENTMAP
uniform sampler2D gradientMap;
#endif
vec3 getGradientIrradiance( vec3 normal, vec3 lightDirection ) {
float dotNL = dot( normal, lightDirection );
vec2 coord = vec2( dotNL * 0.5 + 0.5, 0.0 );
#ifdef USE_GRADIENTMAP
return vec3( texture2D( gradientMap, coord ).r );
#else
vec2 fw = fwidth( coord ) * 0.5;
return mix( vec3( 0.7 ), vec3( 1.0 ), smoothstep( 0.7 - fw.x, 0.7 + fw.x, coord.x ) );
#endif
}`,Zp=`#ifdef USE_LIGHTMAP
uniform sampler2D lightMap;
uniform float lightMapIntensity;
#endif`,jp=`LambertMaterial material;
material.diffuseColor = diffuseColor.rgb;
material.specularStrength = specularStrength;`,Jp=`varying vec3 vViewPosition;
struct LambertMaterial {
vec3 diffuseColor;
float specularStrength;
};
void RE_Direct_Lambert( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in LambertMaterial material, inout ReflectedLight reflectedLight ) {
float dotNL = saturate( dot( geometryNormal, directLight.direction ) );
vec3 irradiance = dotNL * directLight.color;
reflectedLight.directDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
void RE_IndirectDiffuse_Lambert( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in LambertMaterial material, inout ReflectedLight reflectedLight ) {
reflectedLight.indirectDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
#define RE_Direct				RE_Direct_Lambert
#define RE_IndirectDiffuse		RE_IndirectDiffuse_Lambert`,Kp=`uniform bool receiveShadow;
uniform vec3 ambientLightColor;
#if defined( USE_LIGHT_PROBES )
uniform vec3 lightProbe[ 9 ];
#endif
vec3 shGetIrradianceAt( in vec3 normal, in vec3 shCoefficients[ 9 ] ) {
float x = normal.x, y = normal.y, z = normal.z;
vec3 result = shCoefficients[ 0 ] * 0.886227;
result += shCoefficients[ 1 ] * 2.0 * 0.511664 * y;
result += shCoefficients[ 2 ] * 2.0 * 0.511664 * z;
result += shCoefficients[ 3 ] * 2.0 * 0.511664 * x;
result += shCoefficients[ 4 ] * 2.0 * 0.429043 * x * y;
result += shCoefficients[ 5 ] * 2.0 * 0.429043 * y * z;
result += shCoefficients[ 6 ] * ( 0.743125 * z * z - 0.247708 );
result += shCoefficients[ 7 ] * 2.0 * 0.429043 * x * z;
result += shCoefficients[ 8 ] * 0.429043 * ( x * x - y * y );
return result;
}
vec3 getLightProbeIrradiance( const in vec3 lightProbe[ 9 ], const in vec3 normal ) {
vec3 worldNormal = transformNormalByInverseViewMatrix( normal, viewMatrix );
vec3 irradiance = shGetIrradianceAt( worldNormal, lightProbe );
return irradiance;
}
vec3 getAmbientLightIrradiance( const in vec3 ambientLightColor ) {
vec3 irradiance = ambientLightColor;
return irradiance;
}
float getDistanceAttenuation( const in float lightDistance, const in float cutoffDistance, const in float decayExponent ) {
float distanceFalloff = 1.0 / max( pow( lightDistance, decayExponent ), 0.01 );
if ( cutoffDistance > 0.0 ) {
distanceFalloff *= pow2( saturate( 1.0 - pow4( lightDistance / cutoffDistance ) ) );
}
return distanceFalloff;
}
float getSpotAttenuation( const in float coneCosine, const in float penumbraCosine, const in float angleCosine ) {
return smoothstep( coneCosine, penumbraCosine, angleCosine );
}
#if NUM_SUN_LIGHTS > 0
struct SunLight {
vec3 direction;
vec3 color;
};
uniform SunLight sunLights[ NUM_SUN_LIGHTS ];
void getSunLightInfo( const in SunLight sunLight, out IncidentLight light ) {
light.color = sunLight.color;
light.direction = sunLight.direction;
light.visible = true;
}
#endif
#if NUM_DIR_LIGHTS > 0
struct DirectionalLight {
vec3 direction;
vec3 color;
};
uniform DirectionalLight directionalLights[ NUM_DIR_LIGHTS ];
void getDirectionalLightInfo( const in DirectionalLight directionalLight, out IncidentLight light ) {
light.color = directionalLight.color;
light.direction = directionalLight.direction;
light.visible = true;
}
#endif
#if NUM_POINT_LIGHTS > 0
struct PointLight {
vec3 position;
vec3 color;
float distance;
float decay;
};
uniform PointLight pointLights[ NUM_POINT_LIGHTS ];
void getPointLightInfo( const in PointLight pointLight, const in vec3 geometryPosition, out IncidentLight light ) {
vec3 lVector = pointLight.position - geometryPosition;
light.direction = normalize( lVector );
float lightDistance = length( lVector );
light.color = pointLight.color;
light.color *= getDistanceAttenuation( lightDistance, pointLight.distance, pointLight.decay );
light.visible = ( light.color != vec3( 0.0 ) );
}
#endif
#if NUM_SPOT_LIGHTS > 0
struct SpotLight {
vec3 position;
vec3 direction;
vec3 color;
float distance;
float decay;
float coneCos;
float penumbraCos;
};
uniform SpotLight spotLights[ NUM_SPOT_LIGHTS ];
void getSpotLightInfo( const in SpotLight spotLight, const in vec3 geometryPosition, out IncidentLight light ) {
vec3 lVector = spotLight.position - geometryPosition;
light.direction = normalize( lVector );
float angleCos = dot( light.direction, spotLight.direction );
float spotAttenuation = getSpotAttenuation( spotLight.coneCos, spotLight.penumbraCos, angleCos );
if ( spotAttenuation > 0.0 ) {
float lightDistance = length( lVector );
light.color = spotLight.color * spotAttenuation;
light.color *= getDistanceAttenuation( lightDistance, spotLight.distance, spotLight.decay );
light.visible = ( light.color != vec3( 0.0 ) );
} else {
light.color = vec3( 0.0 );
light.visible = false;
}
}
#endif
#if NUM_RECT_AREA_LIGHTS > 0
struct RectAreaLight {
vec3 color;
vec3 position;
vec3 halfWidth;
vec3 halfHeight;
};
uniform sampler2D ltc_1;	uniform sampler2D ltc_2;
uniform RectAreaLight rectAreaLights[ NUM_RECT_AREA_LIGHTS ];
#endif
#if NUM_HEMI_LIGHTS > 0
struct HemisphereLight {
vec3 direction;
vec3 skyColor;
vec3 groundColor;
};
uniform HemisphereLight hemisphereLights[ NUM_HEMI_LIGHTS ];
vec3 getHemisphereLightIrradiance( const in HemisphereLight hemiLight, const in vec3 normal ) {
float dotNL = dot( normal, hemiLight.direction );
float hemiDiffuseWeight = 0.5 * dotNL + 0.5;
vec3 irradiance = mix( hemiLight.groundColor, hemiLight.skyColor, hemiDiffuseWeight );
return irradiance;
}
#endif
#include <lightprobes_pars_fragment>`,Qp=`#ifdef USE_ENVMAP
vec3 getIBLIrradiance( const in vec3 normal ) {
#ifdef ENVMAP_TYPE_PMREM
vec3 worldNormal = transformNormalByInverseViewMatrix( normal, viewMatrix );
vec4 envMapColor = textureLod( envMap, envMapRotation * worldNormal, ENVMAP_MAX_LOD );
return PI * envMapColor.rgb * envMapIntensity;
#else
return vec3( 0.0 );
#endif
}
vec3 getIBLRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness ) {
#ifdef ENVMAP_TYPE_PMREM
vec3 reflectVec = reflect( - viewDir, normal );
reflectVec = normalize( mix( reflectVec, normal, pow4( roughness ) ) );
reflectVec = transformDirectionByInverseViewMatrix( reflectVec, viewMatrix );
vec4 envMapColor = textureLod( envMap, envMapRotation * reflectVec, roughnessToMip( roughness ) );
return envMapColor.rgb * envMapIntensity;
#else
return vec3( 0.0 );
#endif
}
#ifdef USE_RETROREFLECTION
vec3 getIBLRetroRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness ) {
#ifdef ENVMAP_TYPE_PMREM
vec3 retroVec = normalize( mix( viewDir, normal, pow4( roughness ) ) );
retroVec = transformDirectionByInverseViewMatrix( retroVec, viewMatrix );
vec4 envMapColor = textureLod( envMap, envMapRotation * retroVec, roughnessToMip( roughness ) );
return envMapColor.rgb * envMapIntensity;
#else
return vec3( 0.0 );
#endif
}
#endif
#ifdef USE_ANISOTROPY
vec3 getIBLAnisotropyRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness, const in vec3 bitangent, const in float anisotropy ) {
#ifdef ENVMAP_TYPE_PMREM
vec3 bentNormal = cross( bitangent, viewDir );
bentNormal = normalize( cross( bentNormal, bitangent ) );
bentNormal = normalize( mix( bentNormal, normal, pow2( pow2( 1.0 - anisotropy * ( 1.0 - roughness ) ) ) ) );
return getIBLRadiance( viewDir, bentNormal, roughness );
#else
return vec3( 0.0 );
#endif
}
#ifdef USE_RETROREFLECTION
vec3 getIBLAnisotropyRetroRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness, const in vec3 bitangent, const in float anisotropy ) {
#ifdef ENVMAP_TYPE_PMREM
vec3 bentNormal = cross( bitangent, viewDir );
bentNormal = normalize( cross( bentNormal, bitangent ) );
bentNormal = normalize( mix( bentNormal, normal, pow2( pow2( 1.0 - anisotropy * ( 1.0 - roughness ) ) ) ) );
return getIBLRetroRadiance( viewDir, bentNormal, roughness );
#else
return vec3( 0.0 );
#endif
}
#endif
#endif
#endif`,em=`ToonMaterial material;
material.diffuseColor = diffuseColor.rgb;`,tm=`varying vec3 vViewPosition;
struct ToonMaterial {
vec3 diffuseColor;
};
void RE_Direct_Toon( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in ToonMaterial material, inout ReflectedLight reflectedLight ) {
vec3 irradiance = getGradientIrradiance( geometryNormal, directLight.direction ) * directLight.color;
reflectedLight.directDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
void RE_IndirectDiffuse_Toon( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in ToonMaterial material, inout ReflectedLight reflectedLight ) {
reflectedLight.indirectDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
#define RE_Direct				RE_Direct_Toon
#define RE_IndirectDiffuse		RE_IndirectDiffuse_Toon`,nm=`BlinnPhongMaterial material;
material.diffuseColor = diffuseColor.rgb;
material.specularColor = specular;
material.specularShininess = shininess;
material.specularStrength = specularStrength;`,im=`varying vec3 vViewPosition;
struct BlinnPhongMaterial {
vec3 diffuseColor;
vec3 specularColor;
float specularShininess;
float specularStrength;
};
void RE_Direct_BlinnPhong( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in BlinnPhongMaterial material, inout ReflectedLight reflectedLight ) {
float dotNL = saturate( dot( geometryNormal, directLight.direction ) );
vec3 irradiance = dotNL * directLight.color;
reflectedLight.directDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
reflectedLight.directSpecular += irradiance * BRDF_BlinnPhong( directLight.direction, geometryViewDir, geometryNormal, material.specularColor, material.specularShininess ) * material.specularStrength;
}
void RE_IndirectDiffuse_BlinnPhong( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in BlinnPhongMaterial material, inout ReflectedLight reflectedLight ) {
reflectedLight.indirectDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
#define RE_Direct				RE_Direct_BlinnPhong
#define RE_IndirectDiffuse		RE_IndirectDiffuse_BlinnPhong`,sm=`PhysicalMaterial material;
material.diffuseColor = diffuseColor.rgb;
material.diffuseContribution = diffuseColor.rgb * ( 1.0 - metalnessFactor );
material.metalness = metalnessFactor;
vec3 dxy = max( abs( dFdx( nonPerturbedNormal ) ), abs( dFdy( nonPerturbedNormal ) ) );
float geometryRoughness = max( max( dxy.x, dxy.y ), dxy.z );
material.roughness = max( roughnessFactor, 0.045 );
material.roughness += geometryRoughness;
material.roughness = min( material.roughness, 1.0 );
#ifdef USE_DIFFUSE_ROUGHNESS
float diffuseRoughnessFactor = diffuseRoughness;
#ifdef USE_DIFFUSE_ROUGHNESSMAP
diffuseRoughnessFactor *= texture2D( diffuseRoughnessMap, vDiffuseRoughnessMapUv ).r;
#endif
material.diffuseRoughness = saturate( diffuseRoughnessFactor );
#endif
#ifdef IOR
material.ior = ior;
#ifdef USE_SPECULAR
float specularIntensityFactor = specularIntensity;
vec3 specularColorFactor = specularColor;
#ifdef USE_SPECULAR_COLORMAP
specularColorFactor *= texture2D( specularColorMap, vSpecularColorMapUv ).rgb;
#endif
#ifdef USE_SPECULAR_INTENSITYMAP
specularIntensityFactor *= texture2D( specularIntensityMap, vSpecularIntensityMapUv ).a;
#endif
material.specularF90 = mix( specularIntensityFactor, 1.0, metalnessFactor );
#else
float specularIntensityFactor = 1.0;
vec3 specularColorFactor = vec3( 1.0 );
material.specularF90 = 1.0;
#endif
material.specularColor = min( pow2( ( material.ior - 1.0 ) / ( material.ior + 1.0 ) ) * specularColorFactor, vec3( 1.0 ) ) * specularIntensityFactor;
material.specularColorBlended = mix( material.specularColor, diffuseColor.rgb, metalnessFactor );
#else
material.specularColor = vec3( 0.04 );
material.specularColorBlended = mix( material.specularColor, diffuseColor.rgb, metalnessFactor );
material.specularF90 = 1.0;
#endif
#ifdef USE_CLEARCOAT
material.clearcoat = clearcoat;
material.clearcoatRoughness = clearcoatRoughness;
material.clearcoatF0 = vec3( 0.04 );
material.clearcoatF90 = 1.0;
#ifdef USE_CLEARCOATMAP
material.clearcoat *= texture2D( clearcoatMap, vClearcoatMapUv ).x;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
material.clearcoatRoughness *= texture2D( clearcoatRoughnessMap, vClearcoatRoughnessMapUv ).y;
#endif
material.clearcoat = saturate( material.clearcoat );	material.clearcoatRoughness = max( material.clearcoatRoughness, 0.045 );
material.clearcoatRoughness += geometryRoughness;
material.clearcoatRoughness = min( material.clearcoatRoughness, 1.0 );
#endif
#ifdef USE_DISPERSION
material.dispersion = dispersion;
#endif
#ifdef USE_RETROREFLECTION
material.retroreflectivity = retroreflectivity;
#endif
#ifdef USE_IRIDESCENCE
material.iridescence = iridescence;
material.iridescenceIOR = iridescenceIOR;
#ifdef USE_IRIDESCENCEMAP
material.iridescence *= texture2D( iridescenceMap, vIridescenceMapUv ).r;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
material.iridescenceThickness = (iridescenceThicknessMaximum - iridescenceThicknessMinimum) * texture2D( iridescenceThicknessMap, vIridescenceThicknessMapUv ).g + iridescenceThicknessMinimum;
#else
material.iridescenceThickness = iridescenceThicknessMaximum;
#endif
#endif
#ifdef USE_SHEEN
material.sheenColor = sheenColor;
#ifdef USE_SHEEN_COLORMAP
material.sheenColor *= texture2D( sheenColorMap, vSheenColorMapUv ).rgb;
#endif
material.sheenRoughness = clamp( sheenRoughness, 0.0001, 1.0 );
#ifdef USE_SHEEN_ROUGHNESSMAP
material.sheenRoughness *= texture2D( sheenRoughnessMap, vSheenRoughnessMapUv ).a;
#endif
#endif
#ifdef USE_ANISOTROPY
#ifdef USE_ANISOTROPYMAP
mat2 anisotropyMat = mat2( anisotropyVector.x, anisotropyVector.y, - anisotropyVector.y, anisotropyVector.x );
vec3 anisotropyPolar = texture2D( anisotropyMap, vAnisotropyMapUv ).rgb;
vec2 anisotropyV = anisotropyMat * normalize( 2.0 * anisotropyPolar.rg - vec2( 1.0 ) ) * anisotropyPolar.b;
#else
vec2 anisotropyV = anisotropyVector;
#endif
material.anisotropy = length( anisotropyV );
if( material.anisotropy == 0.0 ) {
anisotropyV = vec2( 1.0, 0.0 );
} else {
anisotropyV /= material.anisotropy;
material.anisotropy = saturate( material.anisotropy );
}
material.alphaT = mix( pow2( material.roughness ), 1.0, pow2( material.anisotropy ) );
material.anisotropyT = tbn[ 0 ] * anisotropyV.x + tbn[ 1 ] * anisotropyV.y;
material.anisotropyB = tbn[ 1 ] * anisotropyV.x - tbn[ 0 ] * anisotropyV.y;
#endif`,rm=`uniform sampler2D dfgLUT;
struct PhysicalMaterial {
vec3 diffuseColor;
vec3 diffuseContribution;
vec3 specularColor;
vec3 specularColorBlended;
float roughness;
float metalness;
float specularF90;
float dispersion;
vec2 dfg;
vec3 multiScatteringCompensation;
#ifdef USE_DIFFUSE_ROUGHNESS
float diffuseRoughness;
#endif
#ifdef USE_RETROREFLECTION
float retroreflectivity;
#endif
#ifdef USE_CLEARCOAT
float clearcoat;
float clearcoatRoughness;
vec3 clearcoatF0;
float clearcoatF90;
#endif
#ifdef USE_IRIDESCENCE
float iridescence;
float iridescenceIOR;
float iridescenceThickness;
vec3 iridescenceFresnel;
vec3 iridescenceF0Dielectric;
vec3 iridescenceF0Metallic;
#endif
#ifdef USE_SHEEN
vec3 sheenColor;
float sheenRoughness;
#endif
#ifdef IOR
float ior;
#endif
#ifdef USE_TRANSMISSION
float transmission;
float transmissionAlpha;
float thickness;
float attenuationDistance;
vec3 attenuationColor;
#endif
#ifdef USE_ANISOTROPY
float anisotropy;
float alphaT;
vec3 anisotropyT;
vec3 anisotropyB;
#endif
};
vec3 clearcoatSpecularDirect = vec3( 0.0 );
vec3 clearcoatSpecularIndirect = vec3( 0.0 );
vec3 sheenSpecularDirect = vec3( 0.0 );
vec3 sheenSpecularIndirect = vec3(0.0 );
vec3 Schlick_to_F0( const in vec3 f, const in float f90, const in float dotVH ) {
    float x = clamp( 1.0 - dotVH, 0.0, 1.0 );
    float x2 = x * x;
    float x5 = clamp( x * x2 * x2, 0.0, 0.9999 );
    return ( f - vec3( f90 ) * x5 ) / ( 1.0 - x5 );
}
#ifdef USE_DIFFUSE_ROUGHNESS
const float EON_EPSILON = 1e-7;
float FON_DirectionalAlbedo( const in float mu, const in float roughness, const in float A ) {
float muComp = 1.0 - mu;
float gOverPi = muComp * ( 0.0571085289 + muComp * ( 0.491881867 + muComp * ( - 0.332181442 + muComp * 0.0714429953 ) ) );
return A * ( 1.0 + roughness * gOverPi );
}
vec3 BRDF_EON( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in vec3 diffuseColor, const in float roughness ) {
vec3 rho = saturate( diffuseColor );
if ( roughness <= EON_EPSILON ) return BRDF_Lambert( rho );
float dotNL = saturate( dot( normal, lightDir ) );
float dotNV = saturate( dot( normal, viewDir ) );
float s = dot( lightDir, viewDir ) - dotNL * dotNV;
float sOverT = ( s > 0.0 ) ? s / max( max( dotNL, dotNV ), EON_EPSILON ) : s;
float A = 1.0 / ( 1.0 + ( 0.5 - 2.0 / ( 3.0 * PI ) ) * roughness );
vec3 singleScatter = rho * RECIPROCAL_PI * A * ( 1.0 + roughness * sOverT );
float averageAlbedo = A * ( 1.0 + ( 2.0 / 3.0 - 28.0 / ( 15.0 * PI ) ) * roughness );
float albedoV = FON_DirectionalAlbedo( dotNV, roughness, A );
float albedoL = FON_DirectionalAlbedo( dotNL, roughness, A );
vec3 rhoMultiScatter = rho * rho * averageAlbedo / max( vec3( EON_EPSILON ), vec3( 1.0 ) - rho * ( 1.0 - averageAlbedo ) );
vec3 multiScatter = rhoMultiScatter * RECIPROCAL_PI
* max( EON_EPSILON, 1.0 - albedoV )
* max( EON_EPSILON, 1.0 - albedoL )
/ max( EON_EPSILON, 1.0 - averageAlbedo );
return singleScatter + multiScatter;
}
vec3 EON_DirectionalAlbedo( const in vec3 diffuseColor, const in float roughness, const in float dotNV ) {
vec3 rho = saturate( diffuseColor );
if ( roughness <= EON_EPSILON ) return rho;
float A = 1.0 / ( 1.0 + ( 0.5 - 2.0 / ( 3.0 * PI ) ) * roughness );
float directionalAlbedo = FON_DirectionalAlbedo( dotNV, roughness, A );
float averageAlbedo = A * ( 1.0 + ( 2.0 / 3.0 - 28.0 / ( 15.0 * PI ) ) * roughness );
vec3 rhoMultiScatter = rho * rho * averageAlbedo / max( vec3( EON_EPSILON ), vec3( 1.0 ) - rho * ( 1.0 - averageAlbedo ) );
return rho * directionalAlbedo + rhoMultiScatter * ( 1.0 - directionalAlbedo );
}
#endif
float V_GGX_SmithCorrelated( const in float alpha, const in float dotNL, const in float dotNV ) {
float a2 = pow2( alpha );
float gv = dotNL * sqrt( a2 + ( 1.0 - a2 ) * pow2( dotNV ) );
float gl = dotNV * sqrt( a2 + ( 1.0 - a2 ) * pow2( dotNL ) );
return 0.5 / max( gv + gl, EPSILON );
}
float D_GGX( const in float alpha, const in float dotNH ) {
float a2 = pow2( alpha );
float denom = pow2( dotNH ) * ( a2 - 1.0 ) + 1.0;
return RECIPROCAL_PI * a2 / pow2( denom );
}
#ifdef USE_ANISOTROPY
float V_GGX_SmithCorrelated_Anisotropic( const in float alphaT, const in float alphaB, const in float dotTV, const in float dotBV, const in float dotTL, const in float dotBL, const in float dotNV, const in float dotNL ) {
float gv = dotNL * length( vec3( alphaT * dotTV, alphaB * dotBV, dotNV ) );
float gl = dotNV * length( vec3( alphaT * dotTL, alphaB * dotBL, dotNL ) );
return 0.5 / max( gv + gl, EPSILON );
}
float D_GGX_Anisotropic( const in float alphaT, const in float alphaB, const in float dotNH, const in float dotTH, const in float dotBH ) {
float a2 = alphaT * alphaB;
highp vec3 v = vec3( alphaB * dotTH, alphaT * dotBH, a2 * dotNH );
highp float v2 = dot( v, v );
float w2 = a2 / v2;
return RECIPROCAL_PI * a2 * pow2 ( w2 );
}
#endif
#ifdef USE_CLEARCOAT
vec3 BRDF_GGX_Clearcoat( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in PhysicalMaterial material) {
vec3 f0 = material.clearcoatF0;
float f90 = material.clearcoatF90;
float roughness = max( material.clearcoatRoughness, 0.045 );
float alpha = pow2( roughness );
vec3 halfDir = normalize( lightDir + viewDir );
float dotNL = saturate( dot( normal, lightDir ) );
float dotNV = saturate( dot( normal, viewDir ) );
float dotNH = saturate( dot( normal, halfDir ) );
float dotVH = saturate( dot( viewDir, halfDir ) );
vec3 F = F_Schlick( f0, f90, dotVH );
float V = V_GGX_SmithCorrelated( alpha, dotNL, dotNV );
float D = D_GGX( alpha, dotNH );
return F * ( V * D );
}
#endif
vec3 BRDF_GGX( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in PhysicalMaterial material ) {
vec3 f0 = material.specularColorBlended;
float f90 = material.specularF90;
float roughness = max( material.roughness, 0.045 );
float alpha = pow2( roughness );
vec3 halfDir = normalize( lightDir + viewDir );
float dotNL = saturate( dot( normal, lightDir ) );
float dotNV = saturate( dot( normal, viewDir ) );
float dotNH = saturate( dot( normal, halfDir ) );
float dotVH = saturate( dot( viewDir, halfDir ) );
vec3 F = F_Schlick( f0, f90, dotVH );
#ifdef USE_IRIDESCENCE
F = mix( F, material.iridescenceFresnel, material.iridescence );
#endif
#ifdef USE_ANISOTROPY
float dotTL = dot( material.anisotropyT, lightDir );
float dotTV = dot( material.anisotropyT, viewDir );
float dotTH = dot( material.anisotropyT, halfDir );
float dotBL = dot( material.anisotropyB, lightDir );
float dotBV = dot( material.anisotropyB, viewDir );
float dotBH = dot( material.anisotropyB, halfDir );
float alphaT = max( material.alphaT, alpha );
float V = V_GGX_SmithCorrelated_Anisotropic( alphaT, alpha, dotTV, dotBV, dotTL, dotBL, dotNV, dotNL );
float D = D_GGX_Anisotropic( alphaT, alpha, dotNH, dotTH, dotBH );
#else
float V = V_GGX_SmithCorrelated( alpha, dotNL, dotNV );
float D = D_GGX( alpha, dotNH );
#endif
return F * ( V * D );
}
vec2 LTC_Uv( const in vec3 N, const in vec3 V, const in float roughness ) {
const float LUT_SIZE = 64.0;
const float LUT_SCALE = ( LUT_SIZE - 1.0 ) / LUT_SIZE;
const float LUT_BIAS = 0.5 / LUT_SIZE;
float dotNV = saturate( dot( N, V ) );
vec2 uv = vec2( roughness, sqrt( 1.0 - dotNV ) );
uv = uv * LUT_SCALE + LUT_BIAS;
return uv;
}
float LTC_ClippedSphereFormFactor( const in vec3 f ) {
float l = length( f );
return max( ( l * l + f.z ) / ( l + 1.0 ), 0.0 );
}
vec3 LTC_EdgeVectorFormFactor( const in vec3 v1, const in vec3 v2 ) {
float x = dot( v1, v2 );
float y = abs( x );
float a = 0.8543985 + ( 0.4965155 + 0.0145206 * y ) * y;
float b = 3.4175940 + ( 4.1616724 + y ) * y;
float v = a / b;
float theta_sintheta = ( x > 0.0 ) ? v : 0.5 * inversesqrt( max( 1.0 - x * x, 1e-7 ) ) - v;
return cross( v1, v2 ) * theta_sintheta;
}
vec3 LTC_Evaluate( const in vec3 N, const in vec3 V, const in vec3 P, const in mat3 mInv, const in vec3 rectCoords[ 4 ] ) {
vec3 v1 = rectCoords[ 1 ] - rectCoords[ 0 ];
vec3 v2 = rectCoords[ 3 ] - rectCoords[ 0 ];
vec3 lightNormal = cross( v1, v2 );
if( dot( lightNormal, P - rectCoords[ 0 ] ) < 0.0 ) return vec3( 0.0 );
vec3 T1, T2;
T1 = normalize( V - N * dot( V, N ) );
T2 = - cross( N, T1 );
mat3 mat = mInv * transpose( mat3( T1, T2, N ) );
vec3 coords[ 4 ];
coords[ 0 ] = mat * ( rectCoords[ 0 ] - P );
coords[ 1 ] = mat * ( rectCoords[ 1 ] - P );
coords[ 2 ] = mat * ( rectCoords[ 2 ] - P );
coords[ 3 ] = mat * ( rectCoords[ 3 ] - P );
coords[ 0 ] = normalize( coords[ 0 ] );
coords[ 1 ] = normalize( coords[ 1 ] );
coords[ 2 ] = normalize( coords[ 2 ] );
coords[ 3 ] = normalize( coords[ 3 ] );
vec3 vectorFormFactor = vec3( 0.0 );
vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 0 ], coords[ 1 ] );
vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 1 ], coords[ 2 ] );
vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 2 ], coords[ 3 ] );
vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 3 ], coords[ 0 ] );
float result = LTC_ClippedSphereFormFactor( vectorFormFactor );
return vec3( result );
}
#if defined( USE_SHEEN )
float D_Charlie( float roughness, float dotNH ) {
float alpha = pow2( roughness );
float invAlpha = 1.0 / alpha;
float cos2h = dotNH * dotNH;
float sin2h = max( 1.0 - cos2h, 0.0078125 );
return ( 2.0 + invAlpha ) * pow( sin2h, invAlpha * 0.5 ) / ( 2.0 * PI );
}
float V_Neubelt( float dotNV, float dotNL ) {
return saturate( 1.0 / ( 4.0 * ( dotNL + dotNV - dotNL * dotNV ) ) );
}
vec3 BRDF_Sheen( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, vec3 sheenColor, const in float sheenRoughness ) {
vec3 halfDir = normalize( lightDir + viewDir );
float dotNL = saturate( dot( normal, lightDir ) );
float dotNV = saturate( dot( normal, viewDir ) );
float dotNH = saturate( dot( normal, halfDir ) );
float D = D_Charlie( sheenRoughness, dotNH );
float V = V_Neubelt( dotNV, dotNL );
return sheenColor * ( D * V );
}
#endif
float IBLSheenBRDF( const in vec3 normal, const in vec3 viewDir, const in float roughness ) {
float dotNV = saturate( dot( normal, viewDir ) );
float r2 = roughness * roughness;
float rInv = 1.0 / ( roughness + 0.1 );
float a = -1.9362 + 1.0678 * roughness + 0.4573 * r2 - 0.8469 * rInv;
float b = -0.6014 + 0.5538 * roughness - 0.4670 * r2 - 0.1255 * rInv;
float DG = exp( a * dotNV + b );
return saturate( DG );
}
vec3 EnvironmentBRDF( const in vec3 normal, const in vec3 viewDir, const in vec3 specularColor, const in float specularF90, const in float roughness ) {
float dotNV = saturate( dot( normal, viewDir ) );
vec2 fab = texture2D( dfgLUT, vec2( roughness, dotNV ) ).rg;
return specularColor * fab.x + specularF90 * fab.y;
}
#ifdef USE_IRIDESCENCE
void computeMultiscatteringIridescence( const in vec2 fab, const in vec3 specularColor, const in float specularF90, const in float iridescence, const in vec3 iridescenceF0, inout vec3 singleScatter, inout vec3 multiScatter ) {
#else
void computeMultiscattering( const in vec2 fab, const in vec3 specularColor, const in float specularF90, inout vec3 singleScatter, inout vec3 multiScatter ) {
#endif
#ifdef USE_IRIDESCENCE
vec3 Fr = mix( specularColor, iridescenceF0, iridescence );
#else
vec3 Fr = specularColor;
#endif
vec3 FssEss = Fr * fab.x + specularF90 * fab.y;
float Ess = fab.x + fab.y;
float Ems = 1.0 - Ess;
vec3 Favg = Fr + ( 1.0 - Fr ) * 0.047619;	vec3 Fms = FssEss * Favg / ( 1.0 - Ems * Favg );
singleScatter += FssEss;
multiScatter += Fms * Ems;
}
#if NUM_RECT_AREA_LIGHTS > 0
void RE_Direct_RectArea_Physical( const in RectAreaLight rectAreaLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight ) {
vec3 normal = geometryNormal;
vec3 viewDir = geometryViewDir;
vec3 position = geometryPosition;
vec3 lightPos = rectAreaLight.position;
vec3 halfWidth = rectAreaLight.halfWidth;
vec3 halfHeight = rectAreaLight.halfHeight;
vec3 lightColor = rectAreaLight.color;
float roughness = material.roughness;
vec3 rectCoords[ 4 ];
rectCoords[ 0 ] = lightPos + halfWidth - halfHeight;		rectCoords[ 1 ] = lightPos - halfWidth - halfHeight;
rectCoords[ 2 ] = lightPos - halfWidth + halfHeight;
rectCoords[ 3 ] = lightPos + halfWidth + halfHeight;
vec2 uv = LTC_Uv( normal, viewDir, roughness );
vec4 t1 = texture2D( ltc_1, uv );
vec4 t2 = texture2D( ltc_2, uv );
mat3 mInv = mat3(
vec3( t1.x, 0, t1.y ),
vec3(    0, 1,    0 ),
vec3( t1.z, 0, t1.w )
);
vec3 fresnel = ( material.specularColorBlended * t2.x + ( material.specularF90 - material.specularColorBlended ) * t2.y );
reflectedLight.directSpecular += lightColor * fresnel * LTC_Evaluate( normal, viewDir, position, mInv, rectCoords );
reflectedLight.directDiffuse += lightColor * material.diffuseContribution * LTC_Evaluate( normal, viewDir, position, mat3( 1.0 ), rectCoords );
#ifdef USE_CLEARCOAT
vec3 Ncc = geometryClearcoatNormal;
vec2 uvClearcoat = LTC_Uv( Ncc, viewDir, material.clearcoatRoughness );
vec4 t1Clearcoat = texture2D( ltc_1, uvClearcoat );
vec4 t2Clearcoat = texture2D( ltc_2, uvClearcoat );
mat3 mInvClearcoat = mat3(
vec3( t1Clearcoat.x, 0, t1Clearcoat.y ),
vec3(             0, 1,             0 ),
vec3( t1Clearcoat.z, 0, t1Clearcoat.w )
);
vec3 fresnelClearcoat = material.clearcoatF0 * t2Clearcoat.x + ( material.clearcoatF90 - material.clearcoatF0 ) * t2Clearcoat.y;
clearcoatSpecularDirect += lightColor * fresnelClearcoat * LTC_Evaluate( Ncc, viewDir, position, mInvClearcoat, rectCoords );
#endif
}
#endif
void RE_Direct_Physical( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight ) {
float dotNL = saturate( dot( geometryNormal, directLight.direction ) );
vec3 irradiance = dotNL * directLight.color;
#ifdef USE_CLEARCOAT
float dotNLcc = saturate( dot( geometryClearcoatNormal, directLight.direction ) );
vec3 ccIrradiance = dotNLcc * directLight.color;
clearcoatSpecularDirect += ccIrradiance * BRDF_GGX_Clearcoat( directLight.direction, geometryViewDir, geometryClearcoatNormal, material );
#endif
#ifdef USE_SHEEN
 
 		sheenSpecularDirect += irradiance * BRDF_Sheen( directLight.direction, geometryViewDir, geometryNormal, material.sheenColor, material.sheenRoughness );
 
 		float sheenAlbedoV = IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness );
 		float sheenAlbedoL = IBLSheenBRDF( geometryNormal, directLight.direction, material.sheenRoughness );
 
 		float sheenEnergyComp = 1.0 - max3( material.sheenColor ) * max( sheenAlbedoV, sheenAlbedoL );
 
 		irradiance *= sheenEnergyComp;
 
 	#endif
vec3 specularBRDF = BRDF_GGX( directLight.direction, geometryViewDir, geometryNormal, material );
#ifdef USE_RETROREFLECTION
vec3 retroViewDir = reflect( - geometryViewDir, geometryNormal );
vec3 retroSpecularBRDF = BRDF_GGX( directLight.direction, retroViewDir, geometryNormal, material );
specularBRDF = mix( specularBRDF, retroSpecularBRDF, saturate( material.retroreflectivity ) );
#endif
reflectedLight.directSpecular += irradiance * specularBRDF * material.multiScatteringCompensation;
vec3 halfDir = normalize( directLight.direction + geometryViewDir );
float dotVH = saturate( dot( geometryViewDir, halfDir ) );
vec3 F = F_Schlick( material.specularColor, material.specularF90, dotVH );
#ifdef USE_RETROREFLECTION
vec3 retroHalfDir = normalize( directLight.direction + retroViewDir );
float dotRetroVH = saturate( dot( retroViewDir, retroHalfDir ) );
vec3 retroF = F_Schlick( material.specularColor, material.specularF90, dotRetroVH );
F = mix( F, retroF, saturate( material.retroreflectivity ) );
#endif
#ifdef USE_DIFFUSE_ROUGHNESS
vec3 diffuseBRDF = BRDF_EON( directLight.direction, geometryViewDir, geometryNormal, material.diffuseColor, material.diffuseRoughness ) * ( 1.0 - material.metalness );
#else
vec3 diffuseBRDF = BRDF_Lambert( material.diffuseContribution );
#endif
reflectedLight.directDiffuse += irradiance * diffuseBRDF * ( 1.0 - F );
}
void RE_IndirectDiffuse_Physical( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight ) {
vec3 singleScattering = vec3( 0.0 );
vec3 multiScattering = vec3( 0.0 );
#ifdef USE_IRIDESCENCE
computeMultiscatteringIridescence( material.dfg, material.specularColor, material.specularF90, material.iridescence, material.iridescenceF0Dielectric, singleScattering, multiScattering );
#else
computeMultiscattering( material.dfg, material.specularColor, material.specularF90, singleScattering, multiScattering );
#endif
#ifdef USE_DIFFUSE_ROUGHNESS
float dotNV = saturate( dot( geometryNormal, geometryViewDir ) );
vec3 diffuseAlbedo = EON_DirectionalAlbedo( material.diffuseColor, material.diffuseRoughness, dotNV ) * ( 1.0 - material.metalness );
vec3 diffuse = irradiance * RECIPROCAL_PI * diffuseAlbedo * ( 1.0 - singleScattering - multiScattering );
#else
vec3 diffuse = irradiance * BRDF_Lambert( material.diffuseContribution ) * ( 1.0 - singleScattering - multiScattering );
#endif
#ifdef USE_SHEEN
float sheenAlbedo = IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness );
sheenSpecularIndirect += irradiance * material.sheenColor * sheenAlbedo * RECIPROCAL_PI;
float sheenEnergyComp = 1.0 - max3( material.sheenColor ) * sheenAlbedo;
diffuse *= sheenEnergyComp;
#endif
reflectedLight.indirectDiffuse += diffuse;
}
void RE_IndirectSpecular_Physical( const in vec3 radiance, const in vec3 irradiance, const in vec3 clearcoatRadiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight) {
#ifdef USE_CLEARCOAT
clearcoatSpecularIndirect += clearcoatRadiance * EnvironmentBRDF( geometryClearcoatNormal, geometryViewDir, material.clearcoatF0, material.clearcoatF90, material.clearcoatRoughness );
#endif
#ifdef USE_SHEEN
sheenSpecularIndirect += irradiance * material.sheenColor * IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness ) * RECIPROCAL_PI;
 	#endif
vec3 singleScatteringDielectric = vec3( 0.0 );
vec3 multiScatteringDielectric = vec3( 0.0 );
vec3 singleScatteringMetallic = vec3( 0.0 );
vec3 multiScatteringMetallic = vec3( 0.0 );
#ifdef USE_IRIDESCENCE
computeMultiscatteringIridescence( material.dfg, material.specularColor, material.specularF90, material.iridescence, material.iridescenceF0Dielectric, singleScatteringDielectric, multiScatteringDielectric );
computeMultiscatteringIridescence( material.dfg, material.diffuseColor, material.specularF90, material.iridescence, material.iridescenceF0Metallic, singleScatteringMetallic, multiScatteringMetallic );
#else
computeMultiscattering( material.dfg, material.specularColor, material.specularF90, singleScatteringDielectric, multiScatteringDielectric );
computeMultiscattering( material.dfg, material.diffuseColor, material.specularF90, singleScatteringMetallic, multiScatteringMetallic );
#endif
vec3 singleScattering = mix( singleScatteringDielectric, singleScatteringMetallic, material.metalness );
vec3 multiScattering = mix( multiScatteringDielectric, multiScatteringMetallic, material.metalness );
vec3 totalScatteringDielectric = singleScatteringDielectric + multiScatteringDielectric;
#ifdef USE_DIFFUSE_ROUGHNESS
float dotNV = saturate( dot( geometryNormal, geometryViewDir ) );
vec3 diffuse = EON_DirectionalAlbedo( material.diffuseColor, material.diffuseRoughness, dotNV ) * ( 1.0 - material.metalness ) * ( 1.0 - totalScatteringDielectric );
#else
vec3 diffuse = material.diffuseContribution * ( 1.0 - totalScatteringDielectric );
#endif
vec3 cosineWeightedIrradiance = irradiance * RECIPROCAL_PI;
vec3 indirectSpecular = radiance * singleScattering;
indirectSpecular += multiScattering * cosineWeightedIrradiance;
vec3 indirectDiffuse = diffuse * cosineWeightedIrradiance;
#ifdef USE_SHEEN
float sheenAlbedo = IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness );
float sheenEnergyComp = 1.0 - max3( material.sheenColor ) * sheenAlbedo;
indirectSpecular *= sheenEnergyComp;
indirectDiffuse *= sheenEnergyComp;
#endif
reflectedLight.indirectSpecular += indirectSpecular;
reflectedLight.indirectDiffuse += indirectDiffuse;
}
#define RE_Direct				RE_Direct_Physical
#define RE_Direct_RectArea		RE_Direct_RectArea_Physical
#define RE_IndirectDiffuse		RE_IndirectDiffuse_Physical
#define RE_IndirectSpecular		RE_IndirectSpecular_Physical
float computeSpecularOcclusion( const in float dotNV, const in float ambientOcclusion, const in float roughness ) {
return saturate( pow( dotNV + ambientOcclusion, exp2( - 16.0 * roughness - 1.0 ) ) - 1.0 + ambientOcclusion );
}`,om=`
vec3 geometryPosition = - vViewPosition;
vec3 geometryNormal = normal;
vec3 geometryViewDir = ( isOrthographic ) ? vec3( 0, 0, 1 ) : normalize( vViewPosition );
vec3 geometryClearcoatNormal = vec3( 0.0 );
#ifdef USE_CLEARCOAT
geometryClearcoatNormal = clearcoatNormal;
#endif
#ifdef USE_IRIDESCENCE
float dotNVi = saturate( dot( normal, geometryViewDir ) );
if ( material.iridescenceThickness == 0.0 ) {
material.iridescence = 0.0;
} else {
material.iridescence = saturate( material.iridescence );
}
if ( material.iridescence > 0.0 ) {
vec3 iridescenceFresnelDielectric = evalIridescence( 1.0, material.iridescenceIOR, dotNVi, material.iridescenceThickness, material.specularColor );
vec3 iridescenceFresnelMetallic = evalIridescence( 1.0, material.iridescenceIOR, dotNVi, material.iridescenceThickness, material.diffuseColor );
material.iridescenceFresnel = mix( iridescenceFresnelDielectric, iridescenceFresnelMetallic, material.metalness );
material.iridescenceF0Dielectric = Schlick_to_F0( iridescenceFresnelDielectric, 1.0, dotNVi );
material.iridescenceF0Metallic = Schlick_to_F0( iridescenceFresnelMetallic, 1.0, dotNVi );
}
#endif
#ifdef STANDARD
float dotNVms = saturate( dot( geometryNormal, geometryViewDir ) );
material.dfg = texture2D( dfgLUT, vec2( material.roughness, dotNVms ) ).rg;
#if ( NUM_SUN_LIGHTS > 0 || NUM_DIR_LIGHTS > 0 || NUM_POINT_LIGHTS > 0 || NUM_SPOT_LIGHTS > 0 )
float EssMs = material.dfg.x + material.dfg.y;
material.multiScatteringCompensation = 1.0 + material.specularColorBlended * ( 1.0 / EssMs - 1.0 );
#endif
#endif
IncidentLight directLight;
#if ( NUM_POINT_LIGHTS > 0 ) && defined( RE_Direct )
PointLight pointLight;
#if defined( USE_SHADOWMAP ) && NUM_POINT_LIGHT_SHADOWS > 0
PointLightShadow pointLightShadow;
#endif
#pragma unroll_loop_start
for ( int i = 0; i < NUM_POINT_LIGHTS; i ++ ) {
pointLight = pointLights[ i ];
getPointLightInfo( pointLight, geometryPosition, directLight );
#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_POINT_LIGHT_SHADOWS ) && ( defined( SHADOWMAP_TYPE_PCF ) || defined( SHADOWMAP_TYPE_BASIC ) )
pointLightShadow = pointLightShadows[ i ];
directLight.color *= ( directLight.visible && receiveShadow ) ? getPointShadow( pointShadowMap[ i ], pointLightShadow.shadowMapSize, pointLightShadow.shadowIntensity, pointLightShadow.shadowBias, pointLightShadow.shadowRadius, vPointShadowCoord[ i ], pointLightShadow.shadowCameraNear, pointLightShadow.shadowCameraFar ) : 1.0;
#endif
RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
}
#pragma unroll_loop_end
#endif
#if ( NUM_SPOT_LIGHTS > 0 ) && defined( RE_Direct )
SpotLight spotLight;
vec4 spotColor;
vec3 spotLightCoord;
bool inSpotLightMap;
#if defined( USE_SHADOWMAP ) && NUM_SPOT_LIGHT_SHADOWS > 0
SpotLightShadow spotLightShadow;
#endif
#pragma unroll_loop_start
for ( int i = 0; i < NUM_SPOT_LIGHTS; i ++ ) {
spotLight = spotLights[ i ];
getSpotLightInfo( spotLight, geometryPosition, directLight );
#if ( UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS_WITH_MAPS )
#define SPOT_LIGHT_MAP_INDEX UNROLLED_LOOP_INDEX
#elif ( UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS )
#define SPOT_LIGHT_MAP_INDEX NUM_SPOT_LIGHT_MAPS
#else
#define SPOT_LIGHT_MAP_INDEX ( UNROLLED_LOOP_INDEX - NUM_SPOT_LIGHT_SHADOWS + NUM_SPOT_LIGHT_SHADOWS_WITH_MAPS )
#endif
#if ( SPOT_LIGHT_MAP_INDEX < NUM_SPOT_LIGHT_MAPS )
spotLightCoord = vSpotLightCoord[ i ].xyz / vSpotLightCoord[ i ].w;
inSpotLightMap = all( lessThan( abs( spotLightCoord * 2. - 1. ), vec3( 1.0 ) ) );
spotColor = texture2D( spotLightMap[ SPOT_LIGHT_MAP_INDEX ], spotLightCoord.xy );
directLight.color = inSpotLightMap ? directLight.color * spotColor.rgb : directLight.color;
#endif
#undef SPOT_LIGHT_MAP_INDEX
#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS )
spotLightShadow = spotLightShadows[ i ];
directLight.color *= ( directLight.visible && receiveShadow ) ? getShadow( spotShadowMap[ i ], spotLightShadow.shadowMapSize, spotLightShadow.shadowIntensity, spotLightShadow.shadowBias, spotLightShadow.shadowRadius, vSpotLightCoord[ i ] ) : 1.0;
#endif
RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
}
#pragma unroll_loop_end
#endif
#if ( NUM_SUN_LIGHTS > 0 ) && defined( RE_Direct )
SunLight sunLight;
#if defined( USE_SHADOWMAP ) && NUM_SUN_LIGHT_SHADOWS > 0
SunLightShadow sunLightShadow;
#endif
#pragma unroll_loop_start
for ( int i = 0; i < NUM_SUN_LIGHTS; i ++ ) {
sunLight = sunLights[ i ];
getSunLightInfo( sunLight, directLight );
#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_SUN_LIGHT_SHADOWS )
sunLightShadow = sunLightShadows[ i ];
directLight.color *= ( directLight.visible && receiveShadow ) ? getSunShadow( sunShadowMap[ i ], sunLightShadow, UNROLLED_LOOP_INDEX ) : 1.0;
#endif
RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
}
#pragma unroll_loop_end
#endif
#if ( NUM_DIR_LIGHTS > 0 ) && defined( RE_Direct )
DirectionalLight directionalLight;
#if defined( USE_SHADOWMAP ) && NUM_DIR_LIGHT_SHADOWS > 0
DirectionalLightShadow directionalLightShadow;
#endif
#pragma unroll_loop_start
for ( int i = 0; i < NUM_DIR_LIGHTS; i ++ ) {
directionalLight = directionalLights[ i ];
getDirectionalLightInfo( directionalLight, directLight );
#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_DIR_LIGHT_SHADOWS )
directionalLightShadow = directionalLightShadows[ i ];
directLight.color *= ( directLight.visible && receiveShadow ) ? getShadow( directionalShadowMap[ i ], directionalLightShadow.shadowMapSize, directionalLightShadow.shadowIntensity, directionalLightShadow.shadowBias, directionalLightShadow.shadowRadius, vDirectionalShadowCoord[ i ] ) : 1.0;
#endif
RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
}
#pragma unroll_loop_end
#endif
#if ( NUM_RECT_AREA_LIGHTS > 0 ) && defined( RE_Direct_RectArea )
RectAreaLight rectAreaLight;
#pragma unroll_loop_start
for ( int i = 0; i < NUM_RECT_AREA_LIGHTS; i ++ ) {
rectAreaLight = rectAreaLights[ i ];
RE_Direct_RectArea( rectAreaLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
}
#pragma unroll_loop_end
#endif
#if defined( RE_IndirectDiffuse )
vec3 iblIrradiance = vec3( 0.0 );
vec3 irradiance = getAmbientLightIrradiance( ambientLightColor );
#if defined( USE_LIGHT_PROBES )
irradiance += getLightProbeIrradiance( lightProbe, geometryNormal );
#endif
#if ( NUM_HEMI_LIGHTS > 0 )
#pragma unroll_loop_start
for ( int i = 0; i < NUM_HEMI_LIGHTS; i ++ ) {
irradiance += getHemisphereLightIrradiance( hemisphereLights[ i ], geometryNormal );
}
#pragma unroll_loop_end
#endif
#if NUM_LIGHT_PROBE_GRIDS > 0
vec3 probeWorldPos = ( ( vec4( geometryPosition, 1.0 ) - viewMatrix[ 3 ] ) * viewMatrix ).xyz;
vec3 probeWorldNormal = transformNormalByInverseViewMatrix( geometryNormal, viewMatrix );
int probeGrid = - 1;
#pragma unroll_loop_start
for ( int i = 0; i < NUM_LIGHT_PROBE_GRIDS; i ++ ) {
if ( isInsideLightProbeGrid( probeWorldPos, probeWorldNormal, probesMin[ i ], probesMax[ i ], probesResolution[ i ] ) ) probeGrid = UNROLLED_LOOP_INDEX;
}
#pragma unroll_loop_end
#pragma unroll_loop_start
for ( int i = 0; i < NUM_LIGHT_PROBE_GRIDS; i ++ ) {
if ( probeGrid == UNROLLED_LOOP_INDEX ) irradiance += getLightProbeGridIrradiance( probesSH[ i ], probesMin[ i ], probesMax[ i ], probesResolution[ i ], probeWorldPos, probeWorldNormal );
}
#pragma unroll_loop_end
#endif
#endif
#if defined( RE_IndirectSpecular )
vec3 radiance = vec3( 0.0 );
vec3 clearcoatRadiance = vec3( 0.0 );
#endif`,am=`#if defined( RE_IndirectDiffuse )
#ifdef USE_LIGHTMAP
vec4 lightMapTexel = texture2D( lightMap, vLightMapUv );
vec3 lightMapIrradiance = lightMapTexel.rgb * lightMapIntensity;
irradiance += lightMapIrradiance;
#endif
#if defined( USE_ENVMAP ) && defined( ENVMAP_TYPE_PMREM )
#if defined( STANDARD ) || defined( LAMBERT ) || defined( PHONG )
iblIrradiance += getIBLIrradiance( geometryNormal );
#endif
#endif
#endif
#if defined( USE_ENVMAP ) && defined( RE_IndirectSpecular )
#ifdef USE_ANISOTROPY
vec3 iblRadiance = getIBLAnisotropyRadiance( geometryViewDir, geometryNormal, material.roughness, material.anisotropyB, material.anisotropy );
#else
vec3 iblRadiance = getIBLRadiance( geometryViewDir, geometryNormal, material.roughness );
#endif
#ifdef USE_RETROREFLECTION
#ifdef USE_ANISOTROPY
vec3 retroIBLRadiance = getIBLAnisotropyRetroRadiance( geometryViewDir, geometryNormal, material.roughness, material.anisotropyB, material.anisotropy );
#else
vec3 retroIBLRadiance = getIBLRetroRadiance( geometryViewDir, geometryNormal, material.roughness );
#endif
iblRadiance = mix( iblRadiance, retroIBLRadiance, saturate( material.retroreflectivity ) );
#endif
radiance += iblRadiance;
#ifdef USE_CLEARCOAT
clearcoatRadiance += getIBLRadiance( geometryViewDir, geometryClearcoatNormal, material.clearcoatRoughness );
#endif
#endif`,lm=`#if defined( RE_IndirectDiffuse )
#if defined( LAMBERT ) || defined( PHONG )
irradiance += iblIrradiance;
#endif
RE_IndirectDiffuse( irradiance, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
#endif
#if defined( RE_IndirectSpecular )
RE_IndirectSpecular( radiance, iblIrradiance, clearcoatRadiance, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
#endif`,cm=`#if NUM_LIGHT_PROBE_GRIDS > 0
uniform highp sampler3D probesSH[ NUM_LIGHT_PROBE_GRIDS ];
uniform vec3 probesMin[ NUM_LIGHT_PROBE_GRIDS ];
uniform vec3 probesMax[ NUM_LIGHT_PROBE_GRIDS ];
uniform vec3 probesResolution[ NUM_LIGHT_PROBE_GRIDS ];
bool isInsideLightProbeGrid( vec3 worldPos, vec3 worldNormal, vec3 probesMin, vec3 probesMax, vec3 probesResolution ) {
vec3 spacing = ( probesMax - probesMin ) / probesResolution;
vec3 samplePos = worldPos + worldNormal * spacing * 0.5;
vec3 margin = spacing * 0.01;
return all( greaterThanEqual( samplePos, probesMin - margin ) ) && all( lessThanEqual( samplePos, probesMax + margin ) );
}
vec3 getLightProbeGridIrradiance( highp sampler3D probesSH, vec3 probesMin, vec3 probesMax, vec3 probesResolution, vec3 worldPos, vec3 worldNormal ) {
vec3 res = probesResolution;
vec3 gridRange = probesMax - probesMin;
vec3 probeSpacing = gridRange / res;
vec3 samplePos = worldPos + worldNormal * probeSpacing * 0.5;
vec3 uvw = clamp( ( samplePos - probesMin ) / gridRange, 0.5 / res, 1.0 - 0.5 / res );
float nz          = res.z;
float paddedSlices = nz + 2.0;
float atlasDepth  = 7.0 * paddedSlices;
float uvZBase     = uvw.z * nz + 1.0;
vec4 s0 = texture( probesSH, vec3( uvw.xy, ( uvZBase                       ) / atlasDepth ) );
vec4 s1 = texture( probesSH, vec3( uvw.xy, ( uvZBase +       paddedSlices   ) / atlasDepth ) );
vec4 s2 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 2.0 * paddedSlices   ) / atlasDepth ) );
vec4 s3 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 3.0 * paddedSlices   ) / atlasDepth ) );
vec4 s4 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 4.0 * paddedSlices   ) / atlasDepth ) );
vec4 s5 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 5.0 * paddedSlices   ) / atlasDepth ) );
vec4 s6 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 6.0 * paddedSlices   ) / atlasDepth ) );
vec3 c0 = s0.xyz;
vec3 c1 = vec3( s0.w, s1.xy );
vec3 c2 = vec3( s1.zw, s2.x );
vec3 c3 = s2.yzw;
vec3 c4 = s3.xyz;
vec3 c5 = vec3( s3.w, s4.xy );
vec3 c6 = vec3( s4.zw, s5.x );
vec3 c7 = s5.yzw;
vec3 c8 = s6.xyz;
float x = worldNormal.x, y = worldNormal.y, z = worldNormal.z;
vec3 result = c0 * 0.886227;
result += c1 * 2.0 * 0.511664 * y;
result += c2 * 2.0 * 0.511664 * z;
result += c3 * 2.0 * 0.511664 * x;
result += c4 * 2.0 * 0.429043 * x * y;
result += c5 * 2.0 * 0.429043 * y * z;
result += c6 * ( 0.743125 * z * z - 0.247708 );
result += c7 * 2.0 * 0.429043 * x * z;
result += c8 * 0.429043 * ( x * x - y * y );
return max( result, vec3( 0.0 ) );
}
#endif`,hm=`#if defined( USE_LOGARITHMIC_DEPTH_BUFFER )
gl_FragDepth = vIsPerspective == 0.0 ? gl_FragCoord.z : log2( vFragDepth ) * logDepthBufFC * 0.5;
#endif`,um=`#if defined( USE_LOGARITHMIC_DEPTH_BUFFER )
uniform float logDepthBufFC;
varying float vFragDepth;
varying float vIsPerspective;
#endif`,dm=`#ifdef USE_LOGARITHMIC_DEPTH_BUFFER
varying float vFragDepth;
varying float vIsPerspective;
#endif`,fm=`#ifdef USE_LOGARITHMIC_DEPTH_BUFFER
vFragDepth = 1.0 + gl_Position.w;
vIsPerspective = float( isPerspectiveMatrix( projectionMatrix ) );
#endif`,pm=`#ifdef USE_MAP
vec4 sampledDiffuseColor = texture2D( map, vMapUv );
#ifdef DECODE_VIDEO_TEXTURE
sampledDiffuseColor = sRGBTransferEOTF( sampledDiffuseColor );
#endif
diffuseColor *= sampledDiffuseColor;
#endif`,mm=`#ifdef USE_MAP
uniform sampler2D map;
#endif`,gm=`#if defined( USE_MAP ) || defined( USE_ALPHAMAP )
#if defined( USE_POINTS_UV )
vec2 uv = vUv;
#else
vec2 uv = ( uvTransform * vec3( gl_PointCoord.x, 1.0 - gl_PointCoord.y, 1 ) ).xy;
#endif
#endif
#ifdef USE_MAP
diffuseColor *= texture2D( map, uv );
#endif
#ifdef USE_ALPHAMAP
diffuseColor.a *= texture2D( alphaMap, uv ).g;
#endif`,vm=`#if defined( USE_POINTS_UV )
varying vec2 vUv;
#else
#if defined( USE_MAP ) || defined( USE_ALPHAMAP )
uniform mat3 uvTransform;
#endif
#endif
#ifdef USE_MAP
uniform sampler2D map;
#endif
#ifdef USE_ALPHAMAP
uniform sampler2D alphaMap;
#endif`,xm=`float metalnessFactor = metalness;
#ifdef USE_METALNESSMAP
vec4 texelMetalness = texture2D( metalnessMap, vMetalnessMapUv );
metalnessFactor *= texelMetalness.b;
#endif`,ym=`#ifdef USE_METALNESSMAP
uniform sampler2D metalnessMap;
#endif`,Sm=`#ifdef USE_INSTANCING_MORPH
float morphTargetInfluences[ MORPHTARGETS_COUNT ];
float morphTargetBaseInfluence = texelFetch( morphTexture, ivec2( 0, gl_InstanceID ), 0 ).r;
for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
morphTargetInfluences[i] =  texelFetch( morphTexture, ivec2( i + 1, gl_InstanceID ), 0 ).r;
}
#endif`,Mm=`#if defined( USE_MORPHCOLORS )
#if defined( USE_COLOR_ALPHA )
vColor *= morphTargetBaseInfluence;
#elif defined( USE_COLOR )
vColor.rgb *= morphTargetBaseInfluence;
#endif
for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
#if defined( USE_COLOR_ALPHA )
if ( morphTargetInfluences[ i ] != 0.0 ) vColor += getMorph( gl_VertexID, i, 2 ) * morphTargetInfluences[ i ];
#elif defined( USE_COLOR )
if ( morphTargetInfluences[ i ] != 0.0 ) vColor.rgb += getMorph( gl_VertexID, i, 2 ).rgb * morphTargetInfluences[ i ];
#endif
}
#endif`,bm=`#ifdef USE_MORPHNORMALS
objectNormal *= morphTargetBaseInfluence;
for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
if ( morphTargetInfluences[ i ] != 0.0 ) objectNormal += getMorph( gl_VertexID, i, 1 ).xyz * morphTargetInfluences[ i ];
}
#endif`,_m=`#ifdef USE_MORPHTARGETS
#ifndef USE_INSTANCING_MORPH
uniform float morphTargetBaseInfluence;
uniform float morphTargetInfluences[ MORPHTARGETS_COUNT ];
#endif
uniform sampler2DArray morphTargetsTexture;
uniform ivec2 morphTargetsTextureSize;
vec4 getMorph( const in int vertexIndex, const in int morphTargetIndex, const in int offset ) {
int texelIndex = vertexIndex * MORPHTARGETS_TEXTURE_STRIDE + offset;
int y = texelIndex / morphTargetsTextureSize.x;
int x = texelIndex - y * morphTargetsTextureSize.x;
ivec3 morphUV = ivec3( x, y, morphTargetIndex );
return texelFetch( morphTargetsTexture, morphUV, 0 );
}
#endif`,wm=`#ifdef USE_MORPHTARGETS
transformed *= morphTargetBaseInfluence;
for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
if ( morphTargetInfluences[ i ] != 0.0 ) transformed += getMorph( gl_VertexID, i, 0 ).xyz * morphTargetInfluences[ i ];
}
#endif`,Em=`float faceDirection = gl_FrontFacing ? 1.0 : - 1.0;
#ifdef FLAT_SHADED
vec3 fdx = dFdx( vViewPosition );
vec3 fdy = dFdy( vViewPosition );
vec3 normal = normalize( cross( fdx, fdy ) );
#else
vec3 normal = normalize( vNormal );
#ifdef DOUBLE_SIDED
normal *= faceDirection;
#endif
#endif
#if defined( USE_NORMALMAP_TANGENTSPACE ) || defined( USE_CLEARCOAT_NORMALMAP ) || defined( USE_ANISOTROPY )
#ifdef USE_TANGENT
mat3 tbn = mat3( normalize( vTangent ), normalize( vBitangent ), normal );
#else
mat3 tbn = getTangentFrame( - vViewPosition, normal,
#if defined( USE_NORMALMAP )
vNormalMapUv
#elif defined( USE_CLEARCOAT_NORMALMAP )
vClearcoatNormalMapUv
#else
vUv
#endif
);
#endif
#ifdef DOUBLE_SIDED
tbn[0] *= faceDirection;
tbn[1] *= faceDirection;
#endif
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
#ifdef USE_TANGENT
mat3 tbn2 = mat3( normalize( vTangent ), normalize( vBitangent ), normal );
#else
mat3 tbn2 = getTangentFrame( - vViewPosition, normal, vClearcoatNormalMapUv );
#endif
#ifdef DOUBLE_SIDED
tbn2[0] *= faceDirection;
tbn2[1] *= faceDirection;
#endif
#endif
vec3 nonPerturbedNormal = normal;`,Am=`#ifdef USE_NORMALMAP_OBJECTSPACE
normal = texture2D( normalMap, vNormalMapUv ).xyz * 2.0 - 1.0;
#ifdef FLIP_SIDED
normal = - normal;
#endif
#ifdef DOUBLE_SIDED
normal = normal * faceDirection;
#endif
normal = normalize( normalMatrix * normal );
#elif defined( USE_NORMALMAP_TANGENTSPACE )
vec3 mapN = texture2D( normalMap, vNormalMapUv ).xyz * 2.0 - 1.0;
#if defined( USE_PACKED_NORMALMAP )
mapN = vec3( mapN.xy, sqrt( saturate( 1.0 - dot( mapN.xy, mapN.xy ) ) ) );
#endif
mapN.xy *= normalScale;
normal = normalize( tbn * mapN );
#elif defined( USE_BUMPMAP )
normal = perturbNormalArb( - vViewPosition, normal, dHdxy_fwd(), faceDirection );
#endif`,Tm=`#ifndef FLAT_SHADED
varying vec3 vNormal;
#ifdef USE_TANGENT
varying vec3 vTangent;
varying vec3 vBitangent;
#endif
#endif`,Rm=`#ifndef FLAT_SHADED
varying vec3 vNormal;
#ifdef USE_TANGENT
varying vec3 vTangent;
varying vec3 vBitangent;
#endif
#endif`,Cm=`#ifndef FLAT_SHADED
vNormal = normalize( transformedNormal );
#ifdef USE_TANGENT
vTangent = normalize( transformedTangent );
vBitangent = normalize( cross( vNormal, vTangent ) * tangent.w );
#ifdef FLIP_SIDED
vBitangent = - vBitangent;
#endif
#endif
#endif`,Pm=`#ifdef USE_NORMALMAP
uniform sampler2D normalMap;
uniform vec2 normalScale;
#endif
#ifdef USE_NORMALMAP_OBJECTSPACE
uniform mat3 normalMatrix;
#endif
#if ! defined ( USE_TANGENT ) && ( defined ( USE_NORMALMAP_TANGENTSPACE ) || defined ( USE_CLEARCOAT_NORMALMAP ) || defined( USE_ANISOTROPY ) )
mat3 getTangentFrame( vec3 eye_pos, vec3 surf_norm, vec2 uv ) {
vec3 q0 = dFdx( eye_pos.xyz );
vec3 q1 = dFdy( eye_pos.xyz );
vec2 st0 = dFdx( uv.st );
vec2 st1 = dFdy( uv.st );
vec3 N = surf_norm;
vec3 q1perp = cross( q1, N );
vec3 q0perp = cross( N, q0 );
vec3 T = q1perp * st0.x + q0perp * st1.x;
vec3 B = q1perp * st0.y + q0perp * st1.y;
float det = max( dot( T, T ), dot( B, B ) );
float scale = ( det == 0.0 ) ? 0.0 : inversesqrt( det );
return mat3( T * scale, B * scale, N );
}
#endif`,Lm=`#ifdef USE_CLEARCOAT
vec3 clearcoatNormal = nonPerturbedNormal;
#endif`,Im=`#ifdef USE_CLEARCOAT_NORMALMAP
vec3 clearcoatMapN = texture2D( clearcoatNormalMap, vClearcoatNormalMapUv ).xyz * 2.0 - 1.0;
clearcoatMapN.xy *= clearcoatNormalScale;
clearcoatNormal = normalize( tbn2 * clearcoatMapN );
#endif`,Nm=`#ifdef USE_CLEARCOATMAP
uniform sampler2D clearcoatMap;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
uniform sampler2D clearcoatNormalMap;
uniform vec2 clearcoatNormalScale;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
uniform sampler2D clearcoatRoughnessMap;
#endif`,Dm=`#ifdef USE_IRIDESCENCEMAP
uniform sampler2D iridescenceMap;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
uniform sampler2D iridescenceThicknessMap;
#endif`,Um=`#ifdef OPAQUE
diffuseColor.a = 1.0;
#endif
#ifdef USE_TRANSMISSION
diffuseColor.a *= material.transmissionAlpha;
#endif
gl_FragColor = vec4( outgoingLight, diffuseColor.a );`,Om=`vec3 packNormalToRGB( const in vec3 normal ) {
return normalize( normal ) * 0.5 + 0.5;
}
vec3 unpackRGBToNormal( const in vec3 rgb ) {
return 2.0 * rgb.xyz - 1.0;
}
const float PackUpscale = 256. / 255.;const float UnpackDownscale = 255. / 256.;const float ShiftRight8 = 1. / 256.;
const float Inv255 = 1. / 255.;
const vec4 PackFactors = vec4( 1.0, 256.0, 256.0 * 256.0, 256.0 * 256.0 * 256.0 );
const vec2 UnpackFactors2 = vec2( UnpackDownscale, 1.0 / PackFactors.g );
const vec3 UnpackFactors3 = vec3( UnpackDownscale / PackFactors.rg, 1.0 / PackFactors.b );
const vec4 UnpackFactors4 = vec4( UnpackDownscale / PackFactors.rgb, 1.0 / PackFactors.a );
vec4 packDepthToRGBA( const in float v ) {
if( v <= 0.0 )
return vec4( 0., 0., 0., 0. );
if( v >= 1.0 )
return vec4( 1., 1., 1., 1. );
float vuf;
float af = modf( v * PackFactors.a, vuf );
float bf = modf( vuf * ShiftRight8, vuf );
float gf = modf( vuf * ShiftRight8, vuf );
return vec4( vuf * Inv255, gf * PackUpscale, bf * PackUpscale, af );
}
vec3 packDepthToRGB( const in float v ) {
if( v <= 0.0 )
return vec3( 0., 0., 0. );
if( v >= 1.0 )
return vec3( 1., 1., 1. );
float vuf;
float bf = modf( v * PackFactors.b, vuf );
float gf = modf( vuf * ShiftRight8, vuf );
return vec3( vuf * Inv255, gf * PackUpscale, bf );
}
vec2 packDepthToRG( const in float v ) {
if( v <= 0.0 )
return vec2( 0., 0. );
if( v >= 1.0 )
return vec2( 1., 1. );
float vuf;
float gf = modf( v * 256., vuf );
return vec2( vuf * Inv255, gf );
}
float unpackRGBAToDepth( const in vec4 v ) {
return dot( v, UnpackFactors4 );
}
float unpackRGBToDepth( const in vec3 v ) {
return dot( v, UnpackFactors3 );
}
float unpackRGToDepth( const in vec2 v ) {
return v.r * UnpackFactors2.r + v.g * UnpackFactors2.g;
}
vec4 pack2HalfToRGBA( const in vec2 v ) {
vec4 r = vec4( v.x, fract( v.x * 255.0 ), v.y, fract( v.y * 255.0 ) );
return vec4( r.x - r.y / 255.0, r.y, r.z - r.w / 255.0, r.w );
}
vec2 unpackRGBATo2Half( const in vec4 v ) {
return vec2( v.x + ( v.y / 255.0 ), v.z + ( v.w / 255.0 ) );
}
float viewZToOrthographicDepth( const in float viewZ, const in float near, const in float far ) {
return ( viewZ + near ) / ( near - far );
}
float orthographicDepthToViewZ( const in float depth, const in float near, const in float far ) {
#ifdef USE_REVERSED_DEPTH_BUFFER

return depth * ( far - near ) - far;
#else
return depth * ( near - far ) - near;
#endif
}
float viewZToPerspectiveDepth( const in float viewZ, const in float near, const in float far ) {
return ( ( near + viewZ ) * far ) / ( ( far - near ) * viewZ );
}
float perspectiveDepthToViewZ( const in float depth, const in float near, const in float far ) {

#ifdef USE_REVERSED_DEPTH_BUFFER
return ( near * far ) / ( ( near - far ) * depth - near );
#else
return ( near * far ) / ( ( far - near ) * depth - far );
#endif
}`,Fm=`#ifdef PREMULTIPLIED_ALPHA
gl_FragColor.rgb *= gl_FragColor.a;
#endif`,Bm=`vec4 mvPosition = vec4( transformed, 1.0 );
#ifdef USE_BATCHING
mvPosition = batchingMatrix * mvPosition;
#endif
#ifdef USE_INSTANCING
mvPosition = instanceMatrix * mvPosition;
#endif
mvPosition = modelViewMatrix * mvPosition;
gl_Position = projectionMatrix * mvPosition;`,km=`#ifdef DITHERING
gl_FragColor.rgb = dithering( gl_FragColor.rgb );
#endif`,zm=`#ifdef DITHERING
vec3 dithering( vec3 color ) {
float grid_position = rand( gl_FragCoord.xy );
vec3 dither_shift_RGB = vec3( 0.25 / 255.0, -0.25 / 255.0, 0.25 / 255.0 );
dither_shift_RGB = mix( 2.0 * dither_shift_RGB, -2.0 * dither_shift_RGB, grid_position );
return color + dither_shift_RGB;
}
#endif`,Gm=`float roughnessFactor = roughness;
#ifdef USE_ROUGHNESSMAP
vec4 texelRoughness = texture2D( roughnessMap, vRoughnessMapUv );
roughnessFactor *= texelRoughness.g;
#endif`,Vm=`#ifdef USE_ROUGHNESSMAP
uniform sampler2D roughnessMap;
#endif`,Hm=`#if NUM_SPOT_LIGHT_COORDS > 0
varying vec4 vSpotLightCoord[ NUM_SPOT_LIGHT_COORDS ];
#endif
#if NUM_SPOT_LIGHT_MAPS > 0
uniform sampler2D spotLightMap[ NUM_SPOT_LIGHT_MAPS ];
#endif
#ifdef USE_SHADOWMAP
#if NUM_SUN_LIGHT_SHADOWS > 0
#define SUN_LIGHT_CASCADES 2
#if defined( SHADOWMAP_TYPE_PCF )
uniform sampler2DShadow sunShadowMap[ NUM_SUN_LIGHT_SHADOWS ];
#else
uniform sampler2D sunShadowMap[ NUM_SUN_LIGHT_SHADOWS ];
#endif
uniform mat4 sunShadowMatrix[ NUM_SUN_LIGHT_SHADOWS * SUN_LIGHT_CASCADES ];
uniform vec4 sunShadowCascade[ NUM_SUN_LIGHT_SHADOWS * SUN_LIGHT_CASCADES ];
varying vec4 vSunShadowWorldPosition;
varying vec3 vSunShadowWorldNormal;
struct SunLightShadow {
float shadowIntensity;
float shadowBias;
float shadowNormalBias;
float shadowRadius;
vec2 shadowMapSize;
};
uniform SunLightShadow sunLightShadows[ NUM_SUN_LIGHT_SHADOWS ];
#endif
#if NUM_DIR_LIGHT_SHADOWS > 0
#if defined( SHADOWMAP_TYPE_PCF )
uniform sampler2DShadow directionalShadowMap[ NUM_DIR_LIGHT_SHADOWS ];
#else
uniform sampler2D directionalShadowMap[ NUM_DIR_LIGHT_SHADOWS ];
#endif
varying vec4 vDirectionalShadowCoord[ NUM_DIR_LIGHT_SHADOWS ];
struct DirectionalLightShadow {
float shadowIntensity;
float shadowBias;
float shadowNormalBias;
float shadowRadius;
vec2 shadowMapSize;
};
uniform DirectionalLightShadow directionalLightShadows[ NUM_DIR_LIGHT_SHADOWS ];
#endif
#if NUM_SPOT_LIGHT_SHADOWS > 0
#if defined( SHADOWMAP_TYPE_PCF )
uniform sampler2DShadow spotShadowMap[ NUM_SPOT_LIGHT_SHADOWS ];
#else
uniform sampler2D spotShadowMap[ NUM_SPOT_LIGHT_SHADOWS ];
#endif
struct SpotLightShadow {
float shadowIntensity;
float shadowBias;
float shadowNormalBias;
float shadowRadius;
vec2 shadowMapSize;
};
uniform SpotLightShadow spotLightShadows[ NUM_SPOT_LIGHT_SHADOWS ];
#endif
#if NUM_POINT_LIGHT_SHADOWS > 0
#if defined( SHADOWMAP_TYPE_PCF )
uniform samplerCubeShadow pointShadowMap[ NUM_POINT_LIGHT_SHADOWS ];
#elif defined( SHADOWMAP_TYPE_BASIC )
uniform samplerCube pointShadowMap[ NUM_POINT_LIGHT_SHADOWS ];
#endif
varying vec4 vPointShadowCoord[ NUM_POINT_LIGHT_SHADOWS ];
struct PointLightShadow {
float shadowIntensity;
float shadowBias;
float shadowNormalBias;
float shadowRadius;
vec2 shadowMapSize;
float shadowCameraNear;
float shadowCameraFar;
};
uniform PointLightShadow pointLightShadows[ NUM_POINT_LIGHT_SHADOWS ];
#endif
#if defined( SHADOWMAP_TYPE_PCF )
float interleavedGradientNoise( vec2 position ) {
return fract( 52.9829189 * fract( dot( position, vec2( 0.06711056, 0.00583715 ) ) ) );
}
vec2 vogelDiskSample( int sampleIndex, int samplesCount, float phi ) {
const float goldenAngle = 2.399963229728653;
float r = sqrt( ( float( sampleIndex ) + 0.5 ) / float( samplesCount ) );
float theta = float( sampleIndex ) * goldenAngle + phi;
return vec2( cos( theta ), sin( theta ) ) * r;
}
#endif
#if defined( SHADOWMAP_TYPE_PCF )
float getShadow( sampler2DShadow shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord ) {
float shadow = 1.0;
shadowCoord.xyz /= shadowCoord.w;
#ifdef USE_REVERSED_DEPTH_BUFFER
shadowCoord.z -= shadowBias;
#else
shadowCoord.z += shadowBias;
#endif
bool inFrustum = shadowCoord.x >= 0.0 && shadowCoord.x <= 1.0 && shadowCoord.y >= 0.0 && shadowCoord.y <= 1.0;
bool frustumTest = inFrustum && shadowCoord.z <= 1.0;
if ( frustumTest ) {
vec2 texelSize = vec2( 1.0 ) / shadowMapSize;
vec2 radius = shadowRadius * texelSize;
float phi = interleavedGradientNoise( gl_FragCoord.xy ) * PI2;
shadow = (
texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 0, 5, phi ) * radius, shadowCoord.z ) ) +
texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 1, 5, phi ) * radius, shadowCoord.z ) ) +
texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 2, 5, phi ) * radius, shadowCoord.z ) ) +
texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 3, 5, phi ) * radius, shadowCoord.z ) ) +
texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 4, 5, phi ) * radius, shadowCoord.z ) )
) * 0.2;
}
return mix( 1.0, shadow, shadowIntensity );
}
#elif defined( SHADOWMAP_TYPE_VSM )
float getShadow( sampler2D shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord ) {
float shadow = 1.0;
shadowCoord.xyz /= shadowCoord.w;
#ifdef USE_REVERSED_DEPTH_BUFFER
shadowCoord.z -= shadowBias;
#else
shadowCoord.z += shadowBias;
#endif
bool inFrustum = shadowCoord.x >= 0.0 && shadowCoord.x <= 1.0 && shadowCoord.y >= 0.0 && shadowCoord.y <= 1.0;
bool frustumTest = inFrustum && shadowCoord.z <= 1.0;
if ( frustumTest ) {
vec2 distribution = texture2D( shadowMap, shadowCoord.xy ).rg;
float mean = distribution.x;
float variance = distribution.y * distribution.y;
#ifdef USE_REVERSED_DEPTH_BUFFER
float hard_shadow = step( mean, shadowCoord.z );
#else
float hard_shadow = step( shadowCoord.z, mean );
#endif

if ( hard_shadow == 1.0 ) {
shadow = 1.0;
} else {
variance = max( variance, 0.0000001 );
float d = shadowCoord.z - mean;
float p_max = variance / ( variance + d * d );
p_max = clamp( ( p_max - 0.3 ) / 0.65, 0.0, 1.0 );
shadow = max( hard_shadow, p_max );
}
}
return mix( 1.0, shadow, shadowIntensity );
}
#else
float getShadow( sampler2D shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord ) {
float shadow = 1.0;
shadowCoord.xyz /= shadowCoord.w;
#ifdef USE_REVERSED_DEPTH_BUFFER
shadowCoord.z -= shadowBias;
#else
shadowCoord.z += shadowBias;
#endif
bool inFrustum = shadowCoord.x >= 0.0 && shadowCoord.x <= 1.0 && shadowCoord.y >= 0.0 && shadowCoord.y <= 1.0;
bool frustumTest = inFrustum && shadowCoord.z <= 1.0;
if ( frustumTest ) {
float depth = texture2D( shadowMap, shadowCoord.xy ).r;
#ifdef USE_REVERSED_DEPTH_BUFFER
shadow = step( depth, shadowCoord.z );
#else
shadow = step( shadowCoord.z, depth );
#endif
}
return mix( 1.0, shadow, shadowIntensity );
}
#endif
#if NUM_SUN_LIGHT_SHADOWS > 0
float getSunShadow(
#if defined( SHADOWMAP_TYPE_PCF )
sampler2DShadow shadowMap,
#else
sampler2D shadowMap,
#endif
SunLightShadow sunLightShadow,
int shadowIndex
) {
vec4 shadowWorldPosition = vec4( vSunShadowWorldPosition.xyz + vSunShadowWorldNormal * sunLightShadow.shadowNormalBias, 1.0 );
float viewDepth = vSunShadowWorldPosition.w;
int cascadeOffset = shadowIndex * SUN_LIGHT_CASCADES;
float shadow = 1.0;
for ( int i = SUN_LIGHT_CASCADES - 1; i >= 0; i -- ) {
vec4 cascade = sunShadowCascade[ cascadeOffset + i ];
if ( viewDepth >= cascade.x && viewDepth < cascade.y ) {
float cascadeShadow = getShadow(
shadowMap,
sunLightShadow.shadowMapSize,
sunLightShadow.shadowIntensity,
sunLightShadow.shadowBias,
sunLightShadow.shadowRadius,
sunShadowMatrix[ cascadeOffset + i ] * shadowWorldPosition
);
shadow = mix( cascadeShadow, shadow, smoothstep( cascade.z, cascade.y, viewDepth ) );
}
}
return shadow;
}
#endif
#if NUM_POINT_LIGHT_SHADOWS > 0
#if defined( SHADOWMAP_TYPE_PCF )
float getPointShadow( samplerCubeShadow shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord, float shadowCameraNear, float shadowCameraFar ) {
float shadow = 1.0;
vec3 lightToPosition = shadowCoord.xyz;
vec3 bd3D = normalize( lightToPosition );
vec3 absVec = abs( lightToPosition );
float viewSpaceZ = max( max( absVec.x, absVec.y ), absVec.z );
if ( viewSpaceZ - shadowCameraFar <= 0.0 && viewSpaceZ - shadowCameraNear >= 0.0 ) {
float lightDistance = length( lightToPosition );
float depthRange = shadowCameraFar - shadowCameraNear;
#ifdef USE_REVERSED_DEPTH_BUFFER
float depthA = - shadowCameraNear / depthRange - shadowBias;
float depthB = shadowCameraNear * shadowCameraFar / ( depthRange * lightDistance );
#else
float depthA = shadowCameraFar / depthRange + shadowBias;
float depthB = - shadowCameraNear * shadowCameraFar / ( depthRange * lightDistance );
#endif
float texelSize = shadowRadius / shadowMapSize.x;
vec3 absDir = abs( bd3D );
vec3 tangent = absDir.x > absDir.z ? vec3( 0.0, 1.0, 0.0 ) : vec3( 1.0, 0.0, 0.0 );
tangent = normalize( cross( bd3D, tangent ) );
vec3 bitangent = cross( bd3D, tangent );
float phi = interleavedGradientNoise( gl_FragCoord.xy ) * PI2;
shadow = 0.0;
for ( int i = 0; i < 5; i ++ ) {
vec2 offset = vogelDiskSample( i, 5, phi );
vec3 direction = bd3D + ( tangent * offset.x + bitangent * offset.y ) * texelSize;
vec3 absDirection = abs( direction );
float dp = depthA + depthB / max( max( absDirection.x, absDirection.y ), absDirection.z );
shadow += texture( shadowMap, vec4( direction, dp ) );
}
shadow *= 0.2;
}
return mix( 1.0, shadow, shadowIntensity );
}
#elif defined( SHADOWMAP_TYPE_BASIC )
float getPointShadow( samplerCube shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord, float shadowCameraNear, float shadowCameraFar ) {
float shadow = 1.0;
vec3 lightToPosition = shadowCoord.xyz;
vec3 absVec = abs( lightToPosition );
float viewSpaceZ = max( max( absVec.x, absVec.y ), absVec.z );
if ( viewSpaceZ - shadowCameraFar <= 0.0 && viewSpaceZ - shadowCameraNear >= 0.0 ) {
float dp = ( shadowCameraFar * ( viewSpaceZ - shadowCameraNear ) ) / ( viewSpaceZ * ( shadowCameraFar - shadowCameraNear ) );
dp += shadowBias;
vec3 bd3D = normalize( lightToPosition );
float depth = textureCube( shadowMap, bd3D ).r;
#ifdef USE_REVERSED_DEPTH_BUFFER
depth = 1.0 - depth;
#endif
shadow = step( dp, depth );
}
return mix( 1.0, shadow, shadowIntensity );
}
#endif
#endif
#endif`,Wm=`#if NUM_SPOT_LIGHT_COORDS > 0
uniform mat4 spotLightMatrix[ NUM_SPOT_LIGHT_COORDS ];
varying vec4 vSpotLightCoord[ NUM_SPOT_LIGHT_COORDS ];
#endif
#ifdef USE_SHADOWMAP
#if NUM_SUN_LIGHT_SHADOWS > 0
varying vec4 vSunShadowWorldPosition;
varying vec3 vSunShadowWorldNormal;
#endif
#if NUM_DIR_LIGHT_SHADOWS > 0
uniform mat4 directionalShadowMatrix[ NUM_DIR_LIGHT_SHADOWS ];
varying vec4 vDirectionalShadowCoord[ NUM_DIR_LIGHT_SHADOWS ];
struct DirectionalLightShadow {
float shadowIntensity;
float shadowBias;
float shadowNormalBias;
float shadowRadius;
vec2 shadowMapSize;
};
uniform DirectionalLightShadow directionalLightShadows[ NUM_DIR_LIGHT_SHADOWS ];
#endif
#if NUM_SPOT_LIGHT_SHADOWS > 0
struct SpotLightShadow {
float shadowIntensity;
float shadowBias;
float shadowNormalBias;
float shadowRadius;
vec2 shadowMapSize;
};
uniform SpotLightShadow spotLightShadows[ NUM_SPOT_LIGHT_SHADOWS ];
#endif
#if NUM_POINT_LIGHT_SHADOWS > 0
uniform mat4 pointShadowMatrix[ NUM_POINT_LIGHT_SHADOWS ];
varying vec4 vPointShadowCoord[ NUM_POINT_LIGHT_SHADOWS ];
struct PointLightShadow {
float shadowIntensity;
float shadowBias;
float shadowNormalBias;
float shadowRadius;
vec2 shadowMapSize;
float shadowCameraNear;
float shadowCameraFar;
};
uniform PointLightShadow pointLightShadows[ NUM_POINT_LIGHT_SHADOWS ];
#endif
#endif`,Xm=`#if ( defined( USE_SHADOWMAP ) && ( NUM_DIR_LIGHT_SHADOWS > 0 || NUM_SUN_LIGHT_SHADOWS > 0 || NUM_POINT_LIGHT_SHADOWS > 0 ) ) || ( NUM_SPOT_LIGHT_COORDS > 0 )
#ifdef HAS_NORMAL
vec3 shadowWorldNormal = transformNormalByInverseViewMatrix( transformedNormal, viewMatrix );
#else
vec3 shadowWorldNormal = vec3( 0.0 );
#endif
vec4 shadowWorldPosition;
#endif
#if defined( USE_SHADOWMAP )
#if NUM_SUN_LIGHT_SHADOWS > 0
vSunShadowWorldPosition = vec4( worldPosition.xyz, - mvPosition.z );
vSunShadowWorldNormal = shadowWorldNormal;
#endif
#if NUM_DIR_LIGHT_SHADOWS > 0
#pragma unroll_loop_start
for ( int i = 0; i < NUM_DIR_LIGHT_SHADOWS; i ++ ) {
shadowWorldPosition = worldPosition + vec4( shadowWorldNormal * directionalLightShadows[ i ].shadowNormalBias, 0 );
vDirectionalShadowCoord[ i ] = directionalShadowMatrix[ i ] * shadowWorldPosition;
}
#pragma unroll_loop_end
#endif
#if NUM_POINT_LIGHT_SHADOWS > 0
#pragma unroll_loop_start
for ( int i = 0; i < NUM_POINT_LIGHT_SHADOWS; i ++ ) {
shadowWorldPosition = worldPosition + vec4( shadowWorldNormal * pointLightShadows[ i ].shadowNormalBias, 0 );
vPointShadowCoord[ i ] = pointShadowMatrix[ i ] * shadowWorldPosition;
}
#pragma unroll_loop_end
#endif
#endif
#if NUM_SPOT_LIGHT_COORDS > 0
#pragma unroll_loop_start
for ( int i = 0; i < NUM_SPOT_LIGHT_COORDS; i ++ ) {
shadowWorldPosition = worldPosition;
#if ( defined( USE_SHADOWMAP ) && UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS )
shadowWorldPosition.xyz += shadowWorldNormal * spotLightShadows[ i ].shadowNormalBias;
#endif
vSpotLightCoord[ i ] = spotLightMatrix[ i ] * shadowWorldPosition;
}
#pragma unroll_loop_end
#endif`,qm=`float getShadowMask() {
float shadow = 1.0;
#ifdef USE_SHADOWMAP
#if NUM_SUN_LIGHT_SHADOWS > 0
SunLightShadow sunLight;
#pragma unroll_loop_start
for ( int i = 0; i < NUM_SUN_LIGHT_SHADOWS; i ++ ) {
sunLight = sunLightShadows[ i ];
shadow *= receiveShadow ? getSunShadow( sunShadowMap[ i ], sunLight, UNROLLED_LOOP_INDEX ) : 1.0;
}
#pragma unroll_loop_end
#endif
#if NUM_DIR_LIGHT_SHADOWS > 0
DirectionalLightShadow directionalLight;
#pragma unroll_loop_start
for ( int i = 0; i < NUM_DIR_LIGHT_SHADOWS; i ++ ) {
directionalLight = directionalLightShadows[ i ];
shadow *= receiveShadow ? getShadow( directionalShadowMap[ i ], directionalLight.shadowMapSize, directionalLight.shadowIntensity, directionalLight.shadowBias, directionalLight.shadowRadius, vDirectionalShadowCoord[ i ] ) : 1.0;
}
#pragma unroll_loop_end
#endif
#if NUM_SPOT_LIGHT_SHADOWS > 0
SpotLightShadow spotLight;
#pragma unroll_loop_start
for ( int i = 0; i < NUM_SPOT_LIGHT_SHADOWS; i ++ ) {
spotLight = spotLightShadows[ i ];
shadow *= receiveShadow ? getShadow( spotShadowMap[ i ], spotLight.shadowMapSize, spotLight.shadowIntensity, spotLight.shadowBias, spotLight.shadowRadius, vSpotLightCoord[ i ] ) : 1.0;
}
#pragma unroll_loop_end
#endif
#if NUM_POINT_LIGHT_SHADOWS > 0 && ( defined( SHADOWMAP_TYPE_PCF ) || defined( SHADOWMAP_TYPE_BASIC ) )
PointLightShadow pointLight;
#pragma unroll_loop_start
for ( int i = 0; i < NUM_POINT_LIGHT_SHADOWS; i ++ ) {
pointLight = pointLightShadows[ i ];
shadow *= receiveShadow ? getPointShadow( pointShadowMap[ i ], pointLight.shadowMapSize, pointLight.shadowIntensity, pointLight.shadowBias, pointLight.shadowRadius, vPointShadowCoord[ i ], pointLight.shadowCameraNear, pointLight.shadowCameraFar ) : 1.0;
}
#pragma unroll_loop_end
#endif
#endif
return shadow;
}`,Ym=`#ifdef USE_SKINNING
mat4 boneMatX = getBoneMatrix( skinIndex.x );
mat4 boneMatY = getBoneMatrix( skinIndex.y );
mat4 boneMatZ = getBoneMatrix( skinIndex.z );
mat4 boneMatW = getBoneMatrix( skinIndex.w );
#endif`,$m=`#ifdef USE_SKINNING
uniform mat4 bindMatrix;
uniform mat4 bindMatrixInverse;
uniform highp sampler2D boneTexture;
mat4 getBoneMatrix( const in float i ) {
int size = textureSize( boneTexture, 0 ).x;
int j = int( i ) * 4;
int x = j % size;
int y = j / size;
vec4 v1 = texelFetch( boneTexture, ivec2( x, y ), 0 );
vec4 v2 = texelFetch( boneTexture, ivec2( x + 1, y ), 0 );
vec4 v3 = texelFetch( boneTexture, ivec2( x + 2, y ), 0 );
vec4 v4 = texelFetch( boneTexture, ivec2( x + 3, y ), 0 );
return mat4( v1, v2, v3, v4 );
}
#endif`,Zm=`#ifdef USE_SKINNING
vec4 skinVertex = bindMatrix * vec4( transformed, 1.0 );
vec4 skinned = vec4( 0.0 );
skinned += boneMatX * skinVertex * skinWeight.x;
skinned += boneMatY * skinVertex * skinWeight.y;
skinned += boneMatZ * skinVertex * skinWeight.z;
skinned += boneMatW * skinVertex * skinWeight.w;
transformed = ( bindMatrixInverse * skinned ).xyz;
#endif`,jm=`#ifdef USE_SKINNING
mat4 skinMatrix = mat4( 0.0 );
skinMatrix += skinWeight.x * boneMatX;
skinMatrix += skinWeight.y * boneMatY;
skinMatrix += skinWeight.z * boneMatZ;
skinMatrix += skinWeight.w * boneMatW;
skinMatrix = bindMatrixInverse * skinMatrix * bindMatrix;
objectNormal = vec4( skinMatrix * vec4( objectNormal, 0.0 ) ).xyz;
#ifdef USE_TANGENT
objectTangent = vec4( skinMatrix * vec4( objectTangent, 0.0 ) ).xyz;
#endif
#endif`,Jm=`float specularStrength;
#ifdef USE_SPECULARMAP
vec4 texelSpecular = texture2D( specularMap, vSpecularMapUv );
specularStrength = texelSpecular.r;
#else
specularStrength = 1.0;
#endif`,Km=`#ifdef USE_SPECULARMAP
uniform sampler2D specularMap;
#endif`,Qm=`#if defined( TONE_MAPPING )
gl_FragColor.rgb = toneMapping( gl_FragColor.rgb );
#endif`,eg=`#ifndef saturate
#define saturate( a ) clamp( a, 0.0, 1.0 )
#endif
uniform float toneMappingExposure;
vec3 LinearToneMapping( vec3 color ) {
return saturate( toneMappingExposure * color );
}
vec3 ReinhardToneMapping( vec3 color ) {
color *= toneMappingExposure;
return saturate( color / ( vec3( 1.0 ) + color ) );
}
vec3 CineonToneMapping( vec3 color ) {
color *= toneMappingExposure;
color = max( vec3( 0.0 ), color - 0.004 );
return pow( ( color * ( 6.2 * color + 0.5 ) ) / ( color * ( 6.2 * color + 1.7 ) + 0.06 ), vec3( 2.2 ) );
}
vec3 RRTAndODTFit( vec3 v ) {
vec3 a = v * ( v + 0.0245786 ) - 0.000090537;
vec3 b = v * ( 0.983729 * v + 0.4329510 ) + 0.238081;
return a / b;
}
vec3 ACESFilmicToneMapping( vec3 color ) {
const mat3 ACESInputMat = mat3(
vec3( 0.59719, 0.07600, 0.02840 ),		vec3( 0.35458, 0.90834, 0.13383 ),
vec3( 0.04823, 0.01566, 0.83777 )
);
const mat3 ACESOutputMat = mat3(
vec3(  1.60475, -0.10208, -0.00327 ),		vec3( -0.53108,  1.10813, -0.07276 ),
vec3( -0.07367, -0.00605,  1.07602 )
);
color *= toneMappingExposure / 0.6;
color = ACESInputMat * color;
color = RRTAndODTFit( color );
color = ACESOutputMat * color;
return saturate( color );
}
const mat3 LINEAR_REC2020_TO_LINEAR_SRGB = mat3(
vec3( 1.6605, - 0.1246, - 0.0182 ),
vec3( - 0.5876, 1.1329, - 0.1006 ),
vec3( - 0.0728, - 0.0083, 1.1187 )
);
const mat3 LINEAR_SRGB_TO_LINEAR_REC2020 = mat3(
vec3( 0.6274, 0.0691, 0.0164 ),
vec3( 0.3293, 0.9195, 0.0880 ),
vec3( 0.0433, 0.0113, 0.8956 )
);
vec3 agxDefaultContrastApprox( vec3 x ) {
vec3 x2 = x * x;
vec3 x4 = x2 * x2;
return + 15.5 * x4 * x2
- 40.14 * x4 * x
+ 31.96 * x4
- 6.868 * x2 * x
+ 0.4298 * x2
+ 0.1191 * x
- 0.00232;
}
vec3 AgXToneMapping( vec3 color ) {
const mat3 AgXInsetMatrix = mat3(
vec3( 0.856627153315983, 0.137318972929847, 0.11189821299995 ),
vec3( 0.0951212405381588, 0.761241990602591, 0.0767994186031903 ),
vec3( 0.0482516061458583, 0.101439036467562, 0.811302368396859 )
);
const mat3 AgXOutsetMatrix = mat3(
vec3( 1.1271005818144368, - 0.1413297634984383, - 0.14132976349843826 ),
vec3( - 0.11060664309660323, 1.157823702216272, - 0.11060664309660294 ),
vec3( - 0.016493938717834573, - 0.016493938717834257, 1.2519364065950405 )
);
const float AgxMinEv = - 12.47393;	const float AgxMaxEv = 4.026069;
color *= toneMappingExposure;
color = LINEAR_SRGB_TO_LINEAR_REC2020 * color;
color = AgXInsetMatrix * color;
color = max( color, 1e-10 );	color = log2( color );
color = ( color - AgxMinEv ) / ( AgxMaxEv - AgxMinEv );
color = clamp( color, 0.0, 1.0 );
color = agxDefaultContrastApprox( color );
color = AgXOutsetMatrix * color;
color = pow( max( vec3( 0.0 ), color ), vec3( 2.2 ) );
color = LINEAR_REC2020_TO_LINEAR_SRGB * color;
color = clamp( color, 0.0, 1.0 );
return color;
}
vec3 NeutralToneMapping( vec3 color ) {
const float StartCompression = 0.8 - 0.04;
const float Desaturation = 0.15;
color *= toneMappingExposure;
float x = min( color.r, min( color.g, color.b ) );
float offset = x < 0.08 ? x - 6.25 * x * x : 0.04;
color -= offset;
float peak = max( color.r, max( color.g, color.b ) );
if ( peak < StartCompression ) return color;
float d = 1. - StartCompression;
float newPeak = 1. - d * d / ( peak + d - StartCompression );
color *= newPeak / peak;
float g = 1. - 1. / ( Desaturation * ( peak - newPeak ) + 1. );
return mix( color, vec3( newPeak ), g );
}
vec3 CustomToneMapping( vec3 color ) { return color; }`,tg=`#ifdef USE_TRANSMISSION
material.transmission = transmission;
material.transmissionAlpha = 1.0;
material.thickness = thickness;
material.attenuationDistance = attenuationDistance;
material.attenuationColor = attenuationColor;
#ifdef USE_TRANSMISSIONMAP
material.transmission *= texture2D( transmissionMap, vTransmissionMapUv ).r;
#endif
#ifdef USE_THICKNESSMAP
material.thickness *= texture2D( thicknessMap, vThicknessMapUv ).g;
#endif
vec3 pos = vWorldPosition;
vec3 v = normalize( cameraPosition - pos );
vec3 n = transformNormalByInverseViewMatrix( normal, viewMatrix );
vec4 transmitted = getIBLVolumeRefraction(
n, v, material.roughness, material.diffuseContribution, material.specularColorBlended, material.specularF90,
pos, modelMatrix, viewMatrix, projectionMatrix, material.dispersion, material.ior, material.thickness,
material.attenuationColor, material.attenuationDistance );
material.transmissionAlpha = mix( material.transmissionAlpha, transmitted.a, material.transmission );
totalDiffuse = mix( totalDiffuse, transmitted.rgb, material.transmission );
#endif`,ng=`#ifdef USE_TRANSMISSION
uniform float transmission;
uniform float thickness;
uniform float attenuationDistance;
uniform vec3 attenuationColor;
#ifdef USE_TRANSMISSIONMAP
uniform sampler2D transmissionMap;
#endif
#ifdef USE_THICKNESSMAP
uniform sampler2D thicknessMap;
#endif
uniform vec2 transmissionSamplerSize;
uniform sampler2D transmissionSamplerMap;
uniform mat4 modelMatrix;
uniform mat4 projectionMatrix;
varying vec3 vWorldPosition;
float w0( float a ) {
return ( 1.0 / 6.0 ) * ( a * ( a * ( - a + 3.0 ) - 3.0 ) + 1.0 );
}
float w1( float a ) {
return ( 1.0 / 6.0 ) * ( a *  a * ( 3.0 * a - 6.0 ) + 4.0 );
}
float w2( float a ){
return ( 1.0 / 6.0 ) * ( a * ( a * ( - 3.0 * a + 3.0 ) + 3.0 ) + 1.0 );
}
float w3( float a ) {
return ( 1.0 / 6.0 ) * ( a * a * a );
}
float g0( float a ) {
return w0( a ) + w1( a );
}
float g1( float a ) {
return w2( a ) + w3( a );
}
float h0( float a ) {
return - 1.0 + w1( a ) / ( w0( a ) + w1( a ) );
}
float h1( float a ) {
return 1.0 + w3( a ) / ( w2( a ) + w3( a ) );
}
vec4 bicubic( sampler2D tex, vec2 uv, vec4 texelSize, float lod ) {
uv = uv * texelSize.zw + 0.5;
vec2 iuv = floor( uv );
vec2 fuv = fract( uv );
float g0x = g0( fuv.x );
float g1x = g1( fuv.x );
float h0x = h0( fuv.x );
float h1x = h1( fuv.x );
float h0y = h0( fuv.y );
float h1y = h1( fuv.y );
vec2 p0 = ( vec2( iuv.x + h0x, iuv.y + h0y ) - 0.5 ) * texelSize.xy;
vec2 p1 = ( vec2( iuv.x + h1x, iuv.y + h0y ) - 0.5 ) * texelSize.xy;
vec2 p2 = ( vec2( iuv.x + h0x, iuv.y + h1y ) - 0.5 ) * texelSize.xy;
vec2 p3 = ( vec2( iuv.x + h1x, iuv.y + h1y ) - 0.5 ) * texelSize.xy;
return g0( fuv.y ) * ( g0x * textureLod( tex, p0, lod ) + g1x * textureLod( tex, p1, lod ) ) +
g1( fuv.y ) * ( g0x * textureLod( tex, p2, lod ) + g1x * textureLod( tex, p3, lod ) );
}
vec4 textureBicubic( sampler2D sampler, vec2 uv, float lod ) {
vec2 fLodSize = vec2( textureSize( sampler, int( lod ) ) );
vec2 cLodSize = vec2( textureSize( sampler, int( lod + 1.0 ) ) );
vec2 fLodSizeInv = 1.0 / fLodSize;
vec2 cLodSizeInv = 1.0 / cLodSize;
vec4 fSample = bicubic( sampler, uv, vec4( fLodSizeInv, fLodSize ), floor( lod ) );
vec4 cSample = bicubic( sampler, uv, vec4( cLodSizeInv, cLodSize ), ceil( lod ) );
return mix( fSample, cSample, fract( lod ) );
}
vec3 getVolumeTransmissionRay( const in vec3 n, const in vec3 v, const in float thickness, const in float ior, const in mat4 modelMatrix ) {
vec3 refractionVector = refract( - v, normalize( n ), 1.0 / ior );
vec3 modelScale;
modelScale.x = length( vec3( modelMatrix[ 0 ].xyz ) );
modelScale.y = length( vec3( modelMatrix[ 1 ].xyz ) );
modelScale.z = length( vec3( modelMatrix[ 2 ].xyz ) );
return normalize( refractionVector ) * thickness * modelScale;
}
float applyIorToRoughness( const in float roughness, const in float ior ) {
return roughness * clamp( ior * 2.0 - 2.0, 0.0, 1.0 );
}
vec4 getTransmissionSample( const in vec2 fragCoord, const in float roughness, const in float ior ) {
float lod = log2( transmissionSamplerSize.x ) * applyIorToRoughness( roughness, ior );
return textureBicubic( transmissionSamplerMap, fragCoord.xy, lod );
}
vec3 volumeAttenuation( const in float transmissionDistance, const in vec3 attenuationColor, const in float attenuationDistance ) {
if ( isinf( attenuationDistance ) ) {
return vec3( 1.0 );
} else {
vec3 attenuationCoefficient = -log( attenuationColor ) / attenuationDistance;
vec3 transmittance = exp( - attenuationCoefficient * transmissionDistance );			return transmittance;
}
}
vec4 getIBLVolumeRefraction( const in vec3 n, const in vec3 v, const in float roughness, const in vec3 diffuseColor,
const in vec3 specularColor, const in float specularF90, const in vec3 position, const in mat4 modelMatrix,
const in mat4 viewMatrix, const in mat4 projMatrix, const in float dispersion, const in float ior, const in float thickness,
const in vec3 attenuationColor, const in float attenuationDistance ) {
vec4 transmittedLight;
vec3 transmittance;
#ifdef USE_DISPERSION
float halfSpread = ( ior - 1.0 ) * 0.025 * dispersion;
vec3 iors = vec3( ior - halfSpread, ior, ior + halfSpread );
for ( int i = 0; i < 3; i ++ ) {
vec3 transmissionRay = getVolumeTransmissionRay( n, v, thickness, iors[ i ], modelMatrix );
vec3 refractedRayExit = position + transmissionRay;
vec4 ndcPos = projMatrix * viewMatrix * vec4( refractedRayExit, 1.0 );
vec2 refractionCoords = ndcPos.xy / ndcPos.w;
refractionCoords += 1.0;
refractionCoords /= 2.0;
vec4 transmissionSample = getTransmissionSample( refractionCoords, roughness, iors[ i ] );
transmittedLight[ i ] = transmissionSample[ i ];
transmittedLight.a += transmissionSample.a;
transmittance[ i ] = diffuseColor[ i ] * volumeAttenuation( length( transmissionRay ), attenuationColor, attenuationDistance )[ i ];
}
transmittedLight.a /= 3.0;
#else
vec3 transmissionRay = getVolumeTransmissionRay( n, v, thickness, ior, modelMatrix );
vec3 refractedRayExit = position + transmissionRay;
vec4 ndcPos = projMatrix * viewMatrix * vec4( refractedRayExit, 1.0 );
vec2 refractionCoords = ndcPos.xy / ndcPos.w;
refractionCoords += 1.0;
refractionCoords /= 2.0;
transmittedLight = getTransmissionSample( refractionCoords, roughness, ior );
transmittance = diffuseColor * volumeAttenuation( length( transmissionRay ), attenuationColor, attenuationDistance );
#endif
vec3 attenuatedColor = transmittance * transmittedLight.rgb;
vec3 F = EnvironmentBRDF( n, v, specularColor, specularF90, roughness );
float transmittanceFactor = ( transmittance.r + transmittance.g + transmittance.b ) / 3.0;
return vec4( ( 1.0 - F ) * attenuatedColor, 1.0 - ( 1.0 - transmittedLight.a ) * transmittanceFactor );
}
#endif`,ig=`#if defined( USE_UV ) || defined( USE_ANISOTROPY )
varying vec2 vUv;
#endif
#ifdef USE_MAP
varying vec2 vMapUv;
#endif
#ifdef USE_ALPHAMAP
varying vec2 vAlphaMapUv;
#endif
#ifdef USE_LIGHTMAP
varying vec2 vLightMapUv;
#endif
#ifdef USE_AOMAP
varying vec2 vAoMapUv;
#endif
#ifdef USE_BUMPMAP
varying vec2 vBumpMapUv;
#endif
#ifdef USE_NORMALMAP
varying vec2 vNormalMapUv;
#endif
#ifdef USE_EMISSIVEMAP
varying vec2 vEmissiveMapUv;
#endif
#ifdef USE_METALNESSMAP
varying vec2 vMetalnessMapUv;
#endif
#ifdef USE_ROUGHNESSMAP
varying vec2 vRoughnessMapUv;
#endif
#ifdef USE_DIFFUSE_ROUGHNESSMAP
varying vec2 vDiffuseRoughnessMapUv;
#endif
#ifdef USE_ANISOTROPYMAP
varying vec2 vAnisotropyMapUv;
#endif
#ifdef USE_CLEARCOATMAP
varying vec2 vClearcoatMapUv;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
varying vec2 vClearcoatNormalMapUv;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
varying vec2 vClearcoatRoughnessMapUv;
#endif
#ifdef USE_IRIDESCENCEMAP
varying vec2 vIridescenceMapUv;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
varying vec2 vIridescenceThicknessMapUv;
#endif
#ifdef USE_SHEEN_COLORMAP
varying vec2 vSheenColorMapUv;
#endif
#ifdef USE_SHEEN_ROUGHNESSMAP
varying vec2 vSheenRoughnessMapUv;
#endif
#ifdef USE_SPECULARMAP
varying vec2 vSpecularMapUv;
#endif
#ifdef USE_SPECULAR_COLORMAP
varying vec2 vSpecularColorMapUv;
#endif
#ifdef USE_SPECULAR_INTENSITYMAP
varying vec2 vSpecularIntensityMapUv;
#endif
#ifdef USE_TRANSMISSIONMAP
uniform mat3 transmissionMapTransform;
varying vec2 vTransmissionMapUv;
#endif
#ifdef USE_THICKNESSMAP
uniform mat3 thicknessMapTransform;
varying vec2 vThicknessMapUv;
#endif`,sg=`#if defined( USE_UV ) || defined( USE_ANISOTROPY )
varying vec2 vUv;
#endif
#ifdef USE_MAP
uniform mat3 mapTransform;
varying vec2 vMapUv;
#endif
#ifdef USE_ALPHAMAP
uniform mat3 alphaMapTransform;
varying vec2 vAlphaMapUv;
#endif
#ifdef USE_LIGHTMAP
uniform mat3 lightMapTransform;
varying vec2 vLightMapUv;
#endif
#ifdef USE_AOMAP
uniform mat3 aoMapTransform;
varying vec2 vAoMapUv;
#endif
#ifdef USE_BUMPMAP
uniform mat3 bumpMapTransform;
varying vec2 vBumpMapUv;
#endif
#ifdef USE_NORMALMAP
uniform mat3 normalMapTransform;
varying vec2 vNormalMapUv;
#endif
#ifdef USE_DISPLACEMENTMAP
uniform mat3 displacementMapTransform;
varying vec2 vDisplacementMapUv;
#endif
#ifdef USE_EMISSIVEMAP
uniform mat3 emissiveMapTransform;
varying vec2 vEmissiveMapUv;
#endif
#ifdef USE_METALNESSMAP
uniform mat3 metalnessMapTransform;
varying vec2 vMetalnessMapUv;
#endif
#ifdef USE_ROUGHNESSMAP
uniform mat3 roughnessMapTransform;
varying vec2 vRoughnessMapUv;
#endif
#ifdef USE_DIFFUSE_ROUGHNESSMAP
uniform mat3 diffuseRoughnessMapTransform;
varying vec2 vDiffuseRoughnessMapUv;
#endif
#ifdef USE_ANISOTROPYMAP
uniform mat3 anisotropyMapTransform;
varying vec2 vAnisotropyMapUv;
#endif
#ifdef USE_CLEARCOATMAP
uniform mat3 clearcoatMapTransform;
varying vec2 vClearcoatMapUv;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
uniform mat3 clearcoatNormalMapTransform;
varying vec2 vClearcoatNormalMapUv;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
uniform mat3 clearcoatRoughnessMapTransform;
varying vec2 vClearcoatRoughnessMapUv;
#endif
#ifdef USE_SHEEN_COLORMAP
uniform mat3 sheenColorMapTransform;
varying vec2 vSheenColorMapUv;
#endif
#ifdef USE_SHEEN_ROUGHNESSMAP
uniform mat3 sheenRoughnessMapTransform;
varying vec2 vSheenRoughnessMapUv;
#endif
#ifdef USE_IRIDESCENCEMAP
uniform mat3 iridescenceMapTransform;
varying vec2 vIridescenceMapUv;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
uniform mat3 iridescenceThicknessMapTransform;
varying vec2 vIridescenceThicknessMapUv;
#endif
#ifdef USE_SPECULARMAP
uniform mat3 specularMapTransform;
varying vec2 vSpecularMapUv;
#endif
#ifdef USE_SPECULAR_COLORMAP
uniform mat3 specularColorMapTransform;
varying vec2 vSpecularColorMapUv;
#endif
#ifdef USE_SPECULAR_INTENSITYMAP
uniform mat3 specularIntensityMapTransform;
varying vec2 vSpecularIntensityMapUv;
#endif
#ifdef USE_TRANSMISSIONMAP
uniform mat3 transmissionMapTransform;
varying vec2 vTransmissionMapUv;
#endif
#ifdef USE_THICKNESSMAP
uniform mat3 thicknessMapTransform;
varying vec2 vThicknessMapUv;
#endif`,rg=`#if defined( USE_UV ) || defined( USE_ANISOTROPY )
vUv = vec3( uv, 1 ).xy;
#endif
#ifdef USE_MAP
vMapUv = ( mapTransform * vec3( MAP_UV, 1 ) ).xy;
#endif
#ifdef USE_ALPHAMAP
vAlphaMapUv = ( alphaMapTransform * vec3( ALPHAMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_LIGHTMAP
vLightMapUv = ( lightMapTransform * vec3( LIGHTMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_AOMAP
vAoMapUv = ( aoMapTransform * vec3( AOMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_BUMPMAP
vBumpMapUv = ( bumpMapTransform * vec3( BUMPMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_NORMALMAP
vNormalMapUv = ( normalMapTransform * vec3( NORMALMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_DISPLACEMENTMAP
vDisplacementMapUv = ( displacementMapTransform * vec3( DISPLACEMENTMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_EMISSIVEMAP
vEmissiveMapUv = ( emissiveMapTransform * vec3( EMISSIVEMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_METALNESSMAP
vMetalnessMapUv = ( metalnessMapTransform * vec3( METALNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_ROUGHNESSMAP
vRoughnessMapUv = ( roughnessMapTransform * vec3( ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_DIFFUSE_ROUGHNESSMAP
vDiffuseRoughnessMapUv = ( diffuseRoughnessMapTransform * vec3( DIFFUSE_ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_ANISOTROPYMAP
vAnisotropyMapUv = ( anisotropyMapTransform * vec3( ANISOTROPYMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_CLEARCOATMAP
vClearcoatMapUv = ( clearcoatMapTransform * vec3( CLEARCOATMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
vClearcoatNormalMapUv = ( clearcoatNormalMapTransform * vec3( CLEARCOAT_NORMALMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
vClearcoatRoughnessMapUv = ( clearcoatRoughnessMapTransform * vec3( CLEARCOAT_ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_IRIDESCENCEMAP
vIridescenceMapUv = ( iridescenceMapTransform * vec3( IRIDESCENCEMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
vIridescenceThicknessMapUv = ( iridescenceThicknessMapTransform * vec3( IRIDESCENCE_THICKNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SHEEN_COLORMAP
vSheenColorMapUv = ( sheenColorMapTransform * vec3( SHEEN_COLORMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SHEEN_ROUGHNESSMAP
vSheenRoughnessMapUv = ( sheenRoughnessMapTransform * vec3( SHEEN_ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SPECULARMAP
vSpecularMapUv = ( specularMapTransform * vec3( SPECULARMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SPECULAR_COLORMAP
vSpecularColorMapUv = ( specularColorMapTransform * vec3( SPECULAR_COLORMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SPECULAR_INTENSITYMAP
vSpecularIntensityMapUv = ( specularIntensityMapTransform * vec3( SPECULAR_INTENSITYMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_TRANSMISSIONMAP
vTransmissionMapUv = ( transmissionMapTransform * vec3( TRANSMISSIONMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_THICKNESSMAP
vThicknessMapUv = ( thicknessMapTransform * vec3( THICKNESSMAP_UV, 1 ) ).xy;
#endif`,og=`#if defined( USE_ENVMAP ) || defined( DISTANCE ) || defined ( USE_SHADOWMAP ) || defined ( USE_TRANSMISSION ) || NUM_SPOT_LIGHT_COORDS > 0
vec4 worldPosition = vec4( transformed, 1.0 );
#ifdef USE_BATCHING
worldPosition = batchingMatrix * worldPosition;
#endif
#ifdef USE_INSTANCING
worldPosition = instanceMatrix * worldPosition;
#endif
worldPosition = modelMatrix * worldPosition;
#endif`,ag=`varying vec2 vUv;
uniform mat3 uvTransform;
void main() {
vUv = ( uvTransform * vec3( uv, 1 ) ).xy;
gl_Position = vec4( position.xy, 1.0, 1.0 );
}`,lg=`uniform sampler2D t2D;
uniform float backgroundIntensity;
varying vec2 vUv;
void main() {
vec4 texColor = texture2D( t2D, vUv );
#ifdef DECODE_VIDEO_TEXTURE
texColor = vec4( mix( pow( texColor.rgb * 0.9478672986 + vec3( 0.0521327014 ), vec3( 2.4 ) ), texColor.rgb * 0.0773993808, vec3( lessThanEqual( texColor.rgb, vec3( 0.04045 ) ) ) ), texColor.w );
#endif
texColor.rgb *= backgroundIntensity;
gl_FragColor = texColor;
#include <tonemapping_fragment>
#include <colorspace_fragment>
}`,cg=`varying vec3 vWorldDirection;
#include <common>
void main() {
vWorldDirection = transformDirection( position, modelMatrix );
#include <begin_vertex>
#include <project_vertex>
gl_Position.z = gl_Position.w;
}`,hg=`uniform float backgroundBlurriness;
uniform float backgroundIntensity;
uniform mat3 backgroundRotation;
varying vec3 vWorldDirection;
#include <envmap_common_pars_fragment>
void main() {
#ifdef ENVMAP_TYPE_PMREM
vec4 texColor = textureLod( envMap, backgroundRotation * vWorldDirection, roughnessToMip( backgroundBlurriness ) );
#else
vec4 texColor = textureCube( envMap, backgroundRotation * vWorldDirection );
#endif
texColor.rgb *= backgroundIntensity;
gl_FragColor = texColor;
#include <tonemapping_fragment>
#include <colorspace_fragment>
}`,ug=`varying vec3 vWorldDirection;
#include <common>
void main() {
vWorldDirection = transformDirection( position, modelMatrix );
#include <begin_vertex>
#include <project_vertex>
gl_Position.z = gl_Position.w;
}`,dg=`uniform samplerCube tCube;
uniform float tFlip;
uniform float opacity;
varying vec3 vWorldDirection;
void main() {
vec4 texColor = textureCube( tCube, vec3( tFlip * vWorldDirection.x, vWorldDirection.yz ) );
gl_FragColor = texColor;
gl_FragColor.a *= opacity;
#include <tonemapping_fragment>
#include <colorspace_fragment>
}`,fg=`#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
varying vec2 vHighPrecisionZW;
void main() {
#include <uv_vertex>
#include <batching_vertex>
#include <skinbase_vertex>
#include <morphinstance_vertex>
#ifdef USE_DISPLACEMENTMAP
#include <beginnormal_vertex>
#include <morphnormal_vertex>
#include <skinnormal_vertex>
#endif
#include <begin_vertex>
#include <morphtarget_vertex>
#include <skinning_vertex>
#include <displacementmap_vertex>
#include <project_vertex>
#include <logdepthbuf_vertex>
#include <clipping_planes_vertex>
vHighPrecisionZW = gl_Position.zw;
}`,pg=`#if DEPTH_PACKING == 3200
uniform float opacity;
#endif
#include <common>
#include <packing>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
varying vec2 vHighPrecisionZW;
void main() {
vec4 diffuseColor = vec4( 1.0 );
#include <clipping_planes_fragment>
#if DEPTH_PACKING == 3200
diffuseColor.a = opacity;
#endif
#include <map_fragment>
#include <alphamap_fragment>
#include <alphatest_fragment>
#include <alphahash_fragment>
#include <logdepthbuf_fragment>
#ifdef USE_REVERSED_DEPTH_BUFFER
float fragCoordZ = vHighPrecisionZW[ 0 ] / vHighPrecisionZW[ 1 ];
#else
float fragCoordZ = 0.5 * vHighPrecisionZW[ 0 ] / vHighPrecisionZW[ 1 ] + 0.5;
#endif
#if DEPTH_PACKING == 3200
gl_FragColor = vec4( vec3( 1.0 - fragCoordZ ), opacity );
#elif DEPTH_PACKING == 3201
gl_FragColor = packDepthToRGBA( fragCoordZ );
#elif DEPTH_PACKING == 3202
gl_FragColor = vec4( packDepthToRGB( fragCoordZ ), 1.0 );
#elif DEPTH_PACKING == 3203
gl_FragColor = vec4( packDepthToRG( fragCoordZ ), 0.0, 1.0 );
#endif
}`,mg=`#define DISTANCE
varying vec3 vWorldPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
#include <uv_vertex>
#include <batching_vertex>
#include <skinbase_vertex>
#include <morphinstance_vertex>
#ifdef USE_DISPLACEMENTMAP
#include <beginnormal_vertex>
#include <morphnormal_vertex>
#include <skinnormal_vertex>
#endif
#include <begin_vertex>
#include <morphtarget_vertex>
#include <skinning_vertex>
#include <displacementmap_vertex>
#include <project_vertex>
#include <worldpos_vertex>
#include <clipping_planes_vertex>
vWorldPosition = worldPosition.xyz;
}`,gg=`#define DISTANCE
uniform vec3 referencePosition;
uniform float nearDistance;
uniform float farDistance;
varying vec3 vWorldPosition;
#include <common>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
vec4 diffuseColor = vec4( 1.0 );
#include <clipping_planes_fragment>
#include <map_fragment>
#include <alphamap_fragment>
#include <alphatest_fragment>
#include <alphahash_fragment>
float dist = length( vWorldPosition - referencePosition );
dist = ( dist - nearDistance ) / ( farDistance - nearDistance );
dist = saturate( dist );
gl_FragColor = vec4( dist, 0.0, 0.0, 1.0 );
}`,vg=`varying vec3 vWorldDirection;
#include <common>
void main() {
vWorldDirection = transformDirection( position, modelMatrix );
#include <begin_vertex>
#include <project_vertex>
}`,xg=`uniform sampler2D tEquirect;
varying vec3 vWorldDirection;
#include <common>
void main() {
vec3 direction = normalize( vWorldDirection );
vec2 sampleUV = equirectUv( direction );
gl_FragColor = texture2D( tEquirect, sampleUV );
#include <tonemapping_fragment>
#include <colorspace_fragment>
}`,yg=`uniform float scale;
attribute float lineDistance;
varying float vLineDistance;
#include <common>
#include <uv_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
vLineDistance = scale * lineDistance;
#include <uv_vertex>
#include <color_vertex>
#include <morphinstance_vertex>
#include <morphcolor_vertex>
#include <begin_vertex>
#include <morphtarget_vertex>
#include <project_vertex>
#include <logdepthbuf_vertex>
#include <clipping_planes_vertex>
#include <fog_vertex>
}`,Sg=`uniform vec3 diffuse;
uniform float opacity;
uniform float dashSize;
uniform float totalSize;
varying float vLineDistance;
#include <common>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <fog_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
vec4 diffuseColor = vec4( diffuse, opacity );
#include <clipping_planes_fragment>
if ( mod( vLineDistance, totalSize ) > dashSize ) {
discard;
}
vec3 outgoingLight = vec3( 0.0 );
#include <logdepthbuf_fragment>
#include <map_fragment>
#include <color_fragment>
outgoingLight = diffuseColor.rgb;
#include <opaque_fragment>
#include <tonemapping_fragment>
#include <colorspace_fragment>
#include <fog_fragment>
#include <premultiplied_alpha_fragment>
}`,Mg=`#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <envmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
#include <uv_vertex>
#include <color_vertex>
#include <morphinstance_vertex>
#include <morphcolor_vertex>
#include <batching_vertex>
#if defined ( USE_ENVMAP ) || defined ( USE_SKINNING )
#include <beginnormal_vertex>
#include <morphnormal_vertex>
#include <skinbase_vertex>
#include <skinnormal_vertex>
#include <defaultnormal_vertex>
#endif
#include <begin_vertex>
#include <morphtarget_vertex>
#include <skinning_vertex>
#include <project_vertex>
#include <logdepthbuf_vertex>
#include <clipping_planes_vertex>
#include <worldpos_vertex>
#include <envmap_vertex>
#include <fog_vertex>
}`,bg=`uniform vec3 diffuse;
uniform float opacity;
#ifndef FLAT_SHADED
varying vec3 vNormal;
#endif
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_pars_fragment>
#include <fog_pars_fragment>
#include <specularmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
vec4 diffuseColor = vec4( diffuse, opacity );
#include <clipping_planes_fragment>
#include <logdepthbuf_fragment>
#include <map_fragment>
#include <color_fragment>
#include <alphamap_fragment>
#include <alphatest_fragment>
#include <alphahash_fragment>
#include <specularmap_fragment>
ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
#ifdef USE_LIGHTMAP
vec4 lightMapTexel = texture2D( lightMap, vLightMapUv );
reflectedLight.indirectDiffuse += lightMapTexel.rgb * lightMapIntensity * RECIPROCAL_PI;
#else
reflectedLight.indirectDiffuse += vec3( 1.0 );
#endif
#include <aomap_fragment>
reflectedLight.indirectDiffuse *= diffuseColor.rgb;
vec3 outgoingLight = reflectedLight.indirectDiffuse;
#include <envmap_fragment>
#include <opaque_fragment>
#include <tonemapping_fragment>
#include <colorspace_fragment>
#include <fog_fragment>
#include <premultiplied_alpha_fragment>
#include <dithering_fragment>
}`,_g=`#define LAMBERT
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <envmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
#include <uv_vertex>
#include <color_vertex>
#include <morphinstance_vertex>
#include <morphcolor_vertex>
#include <batching_vertex>
#include <beginnormal_vertex>
#include <morphnormal_vertex>
#include <skinbase_vertex>
#include <skinnormal_vertex>
#include <defaultnormal_vertex>
#include <normal_vertex>
#include <begin_vertex>
#include <morphtarget_vertex>
#include <skinning_vertex>
#include <displacementmap_vertex>
#include <project_vertex>
#include <logdepthbuf_vertex>
#include <clipping_planes_vertex>
vViewPosition = - mvPosition.xyz;
#include <worldpos_vertex>
#include <envmap_vertex>
#include <shadowmap_vertex>
#include <fog_vertex>
}`,wg=`#define LAMBERT
uniform vec3 diffuse;
uniform vec3 emissive;
uniform float opacity;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_pars_fragment>
#include <envmap_physical_pars_fragment>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_lambert_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <specularmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
vec4 diffuseColor = vec4( diffuse, opacity );
#include <clipping_planes_fragment>
ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
vec3 totalEmissiveRadiance = emissive;
#include <logdepthbuf_fragment>
#include <map_fragment>
#include <color_fragment>
#include <alphamap_fragment>
#include <alphatest_fragment>
#include <alphahash_fragment>
#include <specularmap_fragment>
#include <normal_fragment_begin>
#include <normal_fragment_maps>
#include <emissivemap_fragment>
#include <lights_lambert_fragment>
#include <lights_fragment_begin>
#include <lights_fragment_maps>
#include <lights_fragment_end>
#include <aomap_fragment>
vec3 outgoingLight = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse + totalEmissiveRadiance;
#include <envmap_fragment>
#include <opaque_fragment>
#include <tonemapping_fragment>
#include <colorspace_fragment>
#include <fog_fragment>
#include <premultiplied_alpha_fragment>
#include <dithering_fragment>
}`,Eg=`#define MATCAP
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <color_pars_vertex>
#include <displacementmap_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
#include <uv_vertex>
#include <color_vertex>
#include <morphinstance_vertex>
#include <morphcolor_vertex>
#include <batching_vertex>
#include <beginnormal_vertex>
#include <morphnormal_vertex>
#include <skinbase_vertex>
#include <skinnormal_vertex>
#include <defaultnormal_vertex>
#include <normal_vertex>
#include <begin_vertex>
#include <morphtarget_vertex>
#include <skinning_vertex>
#include <displacementmap_vertex>
#include <project_vertex>
#include <logdepthbuf_vertex>
#include <clipping_planes_vertex>
#include <fog_vertex>
vViewPosition = - mvPosition.xyz;
}`,Ag=`#define MATCAP
uniform vec3 diffuse;
uniform float opacity;
uniform sampler2D matcap;
varying vec3 vViewPosition;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <fog_pars_fragment>
#include <normal_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
vec4 diffuseColor = vec4( diffuse, opacity );
#include <clipping_planes_fragment>
#include <logdepthbuf_fragment>
#include <map_fragment>
#include <color_fragment>
#include <alphamap_fragment>
#include <alphatest_fragment>
#include <alphahash_fragment>
#include <normal_fragment_begin>
#include <normal_fragment_maps>
vec3 viewDir = normalize( vViewPosition );
vec3 x = normalize( vec3( viewDir.z, 0.0, - viewDir.x ) );
vec3 y = cross( viewDir, x );
vec2 uv = vec2( dot( x, normal ), dot( y, normal ) ) * 0.495 + 0.5;
#ifdef USE_MATCAP
vec4 matcapColor = texture2D( matcap, uv );
#else
vec4 matcapColor = vec4( vec3( mix( 0.2, 0.8, uv.y ) ), 1.0 );
#endif
vec3 outgoingLight = diffuseColor.rgb * matcapColor.rgb;
#include <opaque_fragment>
#include <tonemapping_fragment>
#include <colorspace_fragment>
#include <fog_fragment>
#include <premultiplied_alpha_fragment>
#include <dithering_fragment>
}`,Tg=`#define NORMAL
#if defined( FLAT_SHADED ) || defined( USE_BUMPMAP ) || defined( USE_NORMALMAP_TANGENTSPACE )
varying vec3 vViewPosition;
#endif
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
#include <uv_vertex>
#include <batching_vertex>
#include <beginnormal_vertex>
#include <morphinstance_vertex>
#include <morphnormal_vertex>
#include <skinbase_vertex>
#include <skinnormal_vertex>
#include <defaultnormal_vertex>
#include <normal_vertex>
#include <begin_vertex>
#include <morphtarget_vertex>
#include <skinning_vertex>
#include <displacementmap_vertex>
#include <project_vertex>
#include <logdepthbuf_vertex>
#include <clipping_planes_vertex>
#if defined( FLAT_SHADED ) || defined( USE_BUMPMAP ) || defined( USE_NORMALMAP_TANGENTSPACE )
vViewPosition = - mvPosition.xyz;
#endif
}`,Rg=`#define NORMAL
uniform float opacity;
#if defined( FLAT_SHADED ) || defined( USE_BUMPMAP ) || defined( USE_NORMALMAP_TANGENTSPACE )
varying vec3 vViewPosition;
#endif
#include <uv_pars_fragment>
#include <normal_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
vec4 diffuseColor = vec4( 0.0, 0.0, 0.0, opacity );
#include <clipping_planes_fragment>
#include <logdepthbuf_fragment>
#include <normal_fragment_begin>
#include <normal_fragment_maps>
gl_FragColor = vec4( normalize( normal ) * 0.5 + 0.5, diffuseColor.a );
#ifdef OPAQUE
gl_FragColor.a = 1.0;
#endif
}`,Cg=`#define PHONG
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <envmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
#include <uv_vertex>
#include <color_vertex>
#include <morphcolor_vertex>
#include <batching_vertex>
#include <beginnormal_vertex>
#include <morphinstance_vertex>
#include <morphnormal_vertex>
#include <skinbase_vertex>
#include <skinnormal_vertex>
#include <defaultnormal_vertex>
#include <normal_vertex>
#include <begin_vertex>
#include <morphtarget_vertex>
#include <skinning_vertex>
#include <displacementmap_vertex>
#include <project_vertex>
#include <logdepthbuf_vertex>
#include <clipping_planes_vertex>
vViewPosition = - mvPosition.xyz;
#include <worldpos_vertex>
#include <envmap_vertex>
#include <shadowmap_vertex>
#include <fog_vertex>
}`,Pg=`#define PHONG
uniform vec3 diffuse;
uniform vec3 emissive;
uniform vec3 specular;
uniform float shininess;
uniform float opacity;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_pars_fragment>
#include <envmap_physical_pars_fragment>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_phong_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <specularmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
vec4 diffuseColor = vec4( diffuse, opacity );
#include <clipping_planes_fragment>
ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
vec3 totalEmissiveRadiance = emissive;
#include <logdepthbuf_fragment>
#include <map_fragment>
#include <color_fragment>
#include <alphamap_fragment>
#include <alphatest_fragment>
#include <alphahash_fragment>
#include <specularmap_fragment>
#include <normal_fragment_begin>
#include <normal_fragment_maps>
#include <emissivemap_fragment>
#include <lights_phong_fragment>
#include <lights_fragment_begin>
#include <lights_fragment_maps>
#include <lights_fragment_end>
#include <aomap_fragment>
vec3 outgoingLight = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse + reflectedLight.directSpecular + reflectedLight.indirectSpecular + totalEmissiveRadiance;
#include <envmap_fragment>
#include <opaque_fragment>
#include <tonemapping_fragment>
#include <colorspace_fragment>
#include <fog_fragment>
#include <premultiplied_alpha_fragment>
#include <dithering_fragment>
}`,Lg=`#define STANDARD
varying vec3 vViewPosition;
#ifdef USE_TRANSMISSION
varying vec3 vWorldPosition;
#endif
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
#include <uv_vertex>
#include <color_vertex>
#include <morphinstance_vertex>
#include <morphcolor_vertex>
#include <batching_vertex>
#include <beginnormal_vertex>
#include <morphnormal_vertex>
#include <skinbase_vertex>
#include <skinnormal_vertex>
#include <defaultnormal_vertex>
#include <normal_vertex>
#include <begin_vertex>
#include <morphtarget_vertex>
#include <skinning_vertex>
#include <displacementmap_vertex>
#include <project_vertex>
#include <logdepthbuf_vertex>
#include <clipping_planes_vertex>
vViewPosition = - mvPosition.xyz;
#include <worldpos_vertex>
#include <shadowmap_vertex>
#include <fog_vertex>
#ifdef USE_TRANSMISSION
vWorldPosition = worldPosition.xyz;
#endif
}`,Ig=`#define STANDARD
#ifdef PHYSICAL
#define IOR
#define USE_SPECULAR
#endif
uniform vec3 diffuse;
uniform vec3 emissive;
uniform float roughness;
uniform float metalness;
uniform float opacity;
#ifdef IOR
uniform float ior;
#endif
#ifdef USE_SPECULAR
uniform float specularIntensity;
uniform vec3 specularColor;
#ifdef USE_SPECULAR_COLORMAP
uniform sampler2D specularColorMap;
#endif
#ifdef USE_SPECULAR_INTENSITYMAP
uniform sampler2D specularIntensityMap;
#endif
#endif
#ifdef USE_CLEARCOAT
uniform float clearcoat;
uniform float clearcoatRoughness;
#endif
#ifdef USE_DIFFUSE_ROUGHNESS
uniform float diffuseRoughness;
#ifdef USE_DIFFUSE_ROUGHNESSMAP
uniform sampler2D diffuseRoughnessMap;
#endif
#endif
#ifdef USE_DISPERSION
uniform float dispersion;
#endif
#ifdef USE_RETROREFLECTION
uniform float retroreflectivity;
#endif
#ifdef USE_IRIDESCENCE
uniform float iridescence;
uniform float iridescenceIOR;
uniform float iridescenceThicknessMinimum;
uniform float iridescenceThicknessMaximum;
#endif
#ifdef USE_SHEEN
uniform vec3 sheenColor;
uniform float sheenRoughness;
#ifdef USE_SHEEN_COLORMAP
uniform sampler2D sheenColorMap;
#endif
#ifdef USE_SHEEN_ROUGHNESSMAP
uniform sampler2D sheenRoughnessMap;
#endif
#endif
#ifdef USE_ANISOTROPY
uniform vec2 anisotropyVector;
#ifdef USE_ANISOTROPYMAP
uniform sampler2D anisotropyMap;
#endif
#endif
varying vec3 vViewPosition;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <iridescence_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_physical_pars_fragment>
#include <fog_pars_fragment>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_physical_pars_fragment>
#include <transmission_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <clearcoat_pars_fragment>
#include <iridescence_pars_fragment>
#include <roughnessmap_pars_fragment>
#include <metalnessmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
vec4 diffuseColor = vec4( diffuse, opacity );
#include <clipping_planes_fragment>
ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
vec3 totalEmissiveRadiance = emissive;
#include <logdepthbuf_fragment>
#include <map_fragment>
#include <color_fragment>
#include <alphamap_fragment>
#include <alphatest_fragment>
#include <alphahash_fragment>
#include <roughnessmap_fragment>
#include <metalnessmap_fragment>
#include <normal_fragment_begin>
#include <normal_fragment_maps>
#include <clearcoat_normal_fragment_begin>
#include <clearcoat_normal_fragment_maps>
#include <emissivemap_fragment>
#include <lights_physical_fragment>
#include <lights_fragment_begin>
#include <lights_fragment_maps>
#include <lights_fragment_end>
#include <aomap_fragment>
vec3 totalDiffuse = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse;
vec3 totalSpecular = reflectedLight.directSpecular + reflectedLight.indirectSpecular;
#include <transmission_fragment>
vec3 outgoingLight = totalDiffuse + totalSpecular + totalEmissiveRadiance;
#ifdef USE_SHEEN
 
outgoingLight = outgoingLight + sheenSpecularDirect + sheenSpecularIndirect;
 
 	#endif
#ifdef USE_CLEARCOAT
float dotNVcc = saturate( dot( geometryClearcoatNormal, geometryViewDir ) );
vec3 Fcc = F_Schlick( material.clearcoatF0, material.clearcoatF90, dotNVcc );
outgoingLight = outgoingLight * ( 1.0 - material.clearcoat * Fcc ) + ( clearcoatSpecularDirect + clearcoatSpecularIndirect ) * material.clearcoat;
#endif
#include <opaque_fragment>
#include <tonemapping_fragment>
#include <colorspace_fragment>
#include <fog_fragment>
#include <premultiplied_alpha_fragment>
#include <dithering_fragment>
}`,Ng=`#define TOON
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
#include <uv_vertex>
#include <color_vertex>
#include <morphinstance_vertex>
#include <morphcolor_vertex>
#include <batching_vertex>
#include <beginnormal_vertex>
#include <morphnormal_vertex>
#include <skinbase_vertex>
#include <skinnormal_vertex>
#include <defaultnormal_vertex>
#include <normal_vertex>
#include <begin_vertex>
#include <morphtarget_vertex>
#include <skinning_vertex>
#include <displacementmap_vertex>
#include <project_vertex>
#include <logdepthbuf_vertex>
#include <clipping_planes_vertex>
vViewPosition = - mvPosition.xyz;
#include <worldpos_vertex>
#include <shadowmap_vertex>
#include <fog_vertex>
}`,Dg=`#define TOON
uniform vec3 diffuse;
uniform vec3 emissive;
uniform float opacity;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <gradientmap_pars_fragment>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_toon_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
vec4 diffuseColor = vec4( diffuse, opacity );
#include <clipping_planes_fragment>
ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
vec3 totalEmissiveRadiance = emissive;
#include <logdepthbuf_fragment>
#include <map_fragment>
#include <color_fragment>
#include <alphamap_fragment>
#include <alphatest_fragment>
#include <alphahash_fragment>
#include <normal_fragment_begin>
#include <normal_fragment_maps>
#include <emissivemap_fragment>
#include <lights_toon_fragment>
#include <lights_fragment_begin>
#include <lights_fragment_maps>
#include <lights_fragment_end>
#include <aomap_fragment>
vec3 outgoingLight = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse + totalEmissiveRadiance;
#include <opaque_fragment>
#include <tonemapping_fragment>
#include <colorspace_fragment>
#include <fog_fragment>
#include <premultiplied_alpha_fragment>
#include <dithering_fragment>
}`,Ug=`uniform float size;
uniform float scale;
#include <common>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
#ifdef USE_POINTS_UV
varying vec2 vUv;
uniform mat3 uvTransform;
#endif
void main() {
#ifdef USE_POINTS_UV
vUv = ( uvTransform * vec3( uv, 1 ) ).xy;
#endif
#include <color_vertex>
#include <morphinstance_vertex>
#include <morphcolor_vertex>
#include <begin_vertex>
#include <morphtarget_vertex>
#include <project_vertex>
gl_PointSize = size;
#ifdef USE_SIZEATTENUATION
bool isPerspective = isPerspectiveMatrix( projectionMatrix );
if ( isPerspective ) gl_PointSize *= ( scale / - mvPosition.z );
#endif
#include <logdepthbuf_vertex>
#include <clipping_planes_vertex>
#include <worldpos_vertex>
#include <fog_vertex>
}`,Og=`uniform vec3 diffuse;
uniform float opacity;
#include <common>
#include <color_pars_fragment>
#include <map_particle_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <fog_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
vec4 diffuseColor = vec4( diffuse, opacity );
#include <clipping_planes_fragment>
vec3 outgoingLight = vec3( 0.0 );
#include <logdepthbuf_fragment>
#include <map_particle_fragment>
#include <color_fragment>
#include <alphatest_fragment>
#include <alphahash_fragment>
outgoingLight = diffuseColor.rgb;
#include <opaque_fragment>
#include <tonemapping_fragment>
#include <colorspace_fragment>
#include <fog_fragment>
#include <premultiplied_alpha_fragment>
}`,Fg=`#include <common>
#include <batching_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <shadowmap_pars_vertex>
void main() {
#include <batching_vertex>
#include <beginnormal_vertex>
#include <morphinstance_vertex>
#include <morphnormal_vertex>
#include <skinbase_vertex>
#include <skinnormal_vertex>
#include <defaultnormal_vertex>
#include <begin_vertex>
#include <morphtarget_vertex>
#include <skinning_vertex>
#include <project_vertex>
#include <logdepthbuf_vertex>
#include <worldpos_vertex>
#include <shadowmap_vertex>
#include <fog_vertex>
}`,Bg=`uniform vec3 color;
uniform float opacity;
#include <common>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <logdepthbuf_pars_fragment>
#include <shadowmap_pars_fragment>
#include <shadowmask_pars_fragment>
void main() {
#include <logdepthbuf_fragment>
gl_FragColor = vec4( color, opacity * ( 1.0 - getShadowMask() ) );
#include <tonemapping_fragment>
#include <colorspace_fragment>
#include <fog_fragment>
#include <premultiplied_alpha_fragment>
}`,kg=`uniform float rotation;
uniform vec2 center;
#include <common>
#include <uv_pars_vertex>
#include <fog_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
#include <uv_vertex>
vec4 mvPosition = modelViewMatrix[ 3 ];
vec2 scale = vec2( length( modelMatrix[ 0 ].xyz ), length( modelMatrix[ 1 ].xyz ) );
#ifndef USE_SIZEATTENUATION
bool isPerspective = isPerspectiveMatrix( projectionMatrix );
if ( isPerspective ) scale *= - mvPosition.z;
#endif
vec2 alignedPosition = ( position.xy - ( center - vec2( 0.5 ) ) ) * scale;
vec2 rotatedPosition;
rotatedPosition.x = cos( rotation ) * alignedPosition.x - sin( rotation ) * alignedPosition.y;
rotatedPosition.y = sin( rotation ) * alignedPosition.x + cos( rotation ) * alignedPosition.y;
mvPosition.xy += rotatedPosition;
gl_Position = projectionMatrix * mvPosition;
#include <logdepthbuf_vertex>
#include <clipping_planes_vertex>
#include <fog_vertex>
}`,zg=`uniform vec3 diffuse;
uniform float opacity;
#include <common>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <fog_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
vec4 diffuseColor = vec4( diffuse, opacity );
#include <clipping_planes_fragment>
vec3 outgoingLight = vec3( 0.0 );
#include <logdepthbuf_fragment>
#include <map_fragment>
#include <alphamap_fragment>
#include <alphatest_fragment>
#include <alphahash_fragment>
outgoingLight = diffuseColor.rgb;
#include <opaque_fragment>
#include <tonemapping_fragment>
#include <colorspace_fragment>
#include <fog_fragment>
}`,Ve={alphahash_fragment:lp,alphahash_pars_fragment:cp,alphamap_fragment:hp,alphamap_pars_fragment:up,alphatest_fragment:dp,alphatest_pars_fragment:fp,aomap_fragment:pp,aomap_pars_fragment:mp,batching_pars_vertex:gp,batching_vertex:vp,begin_vertex:xp,beginnormal_vertex:yp,bsdfs:Sp,iridescence_fragment:Mp,bumpmap_pars_fragment:bp,clipping_planes_fragment:_p,clipping_planes_pars_fragment:wp,clipping_planes_pars_vertex:Ep,clipping_planes_vertex:Ap,color_fragment:Tp,color_pars_fragment:Rp,color_pars_vertex:Cp,color_vertex:Pp,common:Lp,defaultnormal_vertex:Ip,displacementmap_pars_vertex:Np,displacementmap_vertex:Dp,emissivemap_fragment:Up,emissivemap_pars_fragment:Op,colorspace_fragment:Fp,colorspace_pars_fragment:Bp,envmap_fragment:kp,envmap_common_pars_fragment:zp,envmap_pars_fragment:Gp,envmap_pars_vertex:Vp,envmap_physical_pars_fragment:Qp,envmap_vertex:Hp,fog_vertex:Wp,fog_pars_vertex:Xp,fog_fragment:qp,fog_pars_fragment:Yp,gradientmap_pars_fragment:$p,lightmap_pars_fragment:Zp,lights_lambert_fragment:jp,lights_lambert_pars_fragment:Jp,lights_pars_begin:Kp,lights_toon_fragment:em,lights_toon_pars_fragment:tm,lights_phong_fragment:nm,lights_phong_pars_fragment:im,lights_physical_fragment:sm,lights_physical_pars_fragment:rm,lights_fragment_begin:om,lights_fragment_maps:am,lights_fragment_end:lm,lightprobes_pars_fragment:cm,logdepthbuf_fragment:hm,logdepthbuf_pars_fragment:um,logdepthbuf_pars_vertex:dm,logdepthbuf_vertex:fm,map_fragment:pm,map_pars_fragment:mm,map_particle_fragment:gm,map_particle_pars_fragment:vm,metalnessmap_fragment:xm,metalnessmap_pars_fragment:ym,morphinstance_vertex:Sm,morphcolor_vertex:Mm,morphnormal_vertex:bm,morphtarget_pars_vertex:_m,morphtarget_vertex:wm,normal_fragment_begin:Em,normal_fragment_maps:Am,normal_pars_fragment:Tm,normal_pars_vertex:Rm,normal_vertex:Cm,normalmap_pars_fragment:Pm,clearcoat_normal_fragment_begin:Lm,clearcoat_normal_fragment_maps:Im,clearcoat_pars_fragment:Nm,iridescence_pars_fragment:Dm,opaque_fragment:Um,packing:Om,premultiplied_alpha_fragment:Fm,project_vertex:Bm,dithering_fragment:km,dithering_pars_fragment:zm,roughnessmap_fragment:Gm,roughnessmap_pars_fragment:Vm,shadowmap_pars_fragment:Hm,shadowmap_pars_vertex:Wm,shadowmap_vertex:Xm,shadowmask_pars_fragment:qm,skinbase_vertex:Ym,skinning_pars_vertex:$m,skinning_vertex:Zm,skinnormal_vertex:jm,specularmap_fragment:Jm,specularmap_pars_fragment:Km,tonemapping_fragment:Qm,tonemapping_pars_fragment:eg,transmission_fragment:tg,transmission_pars_fragment:ng,uv_pars_fragment:ig,uv_pars_vertex:sg,uv_vertex:rg,worldpos_vertex:og,background_vert:ag,background_frag:lg,backgroundCube_vert:cg,backgroundCube_frag:hg,cube_vert:ug,cube_frag:dg,depth_vert:fg,depth_frag:pg,distance_vert:mg,distance_frag:gg,equirect_vert:vg,equirect_frag:xg,linedashed_vert:yg,linedashed_frag:Sg,meshbasic_vert:Mg,meshbasic_frag:bg,meshlambert_vert:_g,meshlambert_frag:wg,meshmatcap_vert:Eg,meshmatcap_frag:Ag,meshnormal_vert:Tg,meshnormal_frag:Rg,meshphong_vert:Cg,meshphong_frag:Pg,meshphysical_vert:Lg,meshphysical_frag:Ig,meshtoon_vert:Ng,meshtoon_frag:Dg,points_vert:Ug,points_frag:Og,shadow_vert:Fg,shadow_frag:Bg,sprite_vert:kg,sprite_frag:zg},ve={common:{diffuse:{value:new Ze(16777215)},opacity:{value:1},map:{value:null},mapTransform:{value:new Ue},alphaMap:{value:null},alphaMapTransform:{value:new Ue},alphaTest:{value:0}},specularmap:{specularMap:{value:null},specularMapTransform:{value:new Ue}},envmap:{envMap:{value:null},envMapRotation:{value:new Ue},reflectivity:{value:1},ior:{value:1.5},refractionRatio:{value:.98},dfgLUT:{value:null}},aomap:{aoMap:{value:null},aoMapIntensity:{value:1},aoMapTransform:{value:new Ue}},lightmap:{lightMap:{value:null},lightMapIntensity:{value:1},lightMapTransform:{value:new Ue}},bumpmap:{bumpMap:{value:null},bumpMapTransform:{value:new Ue},bumpScale:{value:1}},normalmap:{normalMap:{value:null},normalMapTransform:{value:new Ue},normalScale:{value:new De(1,1)}},displacementmap:{displacementMap:{value:null},displacementMapTransform:{value:new Ue},displacementScale:{value:1},displacementBias:{value:0}},emissivemap:{emissiveMap:{value:null},emissiveMapTransform:{value:new Ue}},metalnessmap:{metalnessMap:{value:null},metalnessMapTransform:{value:new Ue}},roughnessmap:{roughnessMap:{value:null},roughnessMapTransform:{value:new Ue}},gradientmap:{gradientMap:{value:null}},fog:{fogDensity:{value:25e-5},fogNear:{value:1},fogFar:{value:2e3},fogColor:{value:new Ze(16777215)}},lights:{ambientLightColor:{value:[]},lightProbe:{value:[]},sunLights:{value:[],properties:{direction:{},color:{}}},sunLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{}}},sunShadowMatrix:{value:[]},sunShadowCascade:{value:[]},directionalLights:{value:[],properties:{direction:{},color:{}}},directionalLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{}}},directionalShadowMatrix:{value:[]},spotLights:{value:[],properties:{color:{},position:{},direction:{},distance:{},coneCos:{},penumbraCos:{},decay:{}}},spotLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{}}},spotLightMap:{value:[]},spotLightMatrix:{value:[]},pointLights:{value:[],properties:{color:{},position:{},decay:{},distance:{}}},pointLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{},shadowCameraNear:{},shadowCameraFar:{}}},pointShadowMatrix:{value:[]},hemisphereLights:{value:[],properties:{direction:{},skyColor:{},groundColor:{}}},rectAreaLights:{value:[],properties:{color:{},position:{},width:{},height:{}}},ltc_1:{value:null},ltc_2:{value:null},probesSH:{value:[]},probesMin:{value:[]},probesMax:{value:[]},probesResolution:{value:[]}},points:{diffuse:{value:new Ze(16777215)},opacity:{value:1},size:{value:1},scale:{value:1},map:{value:null},alphaMap:{value:null},alphaMapTransform:{value:new Ue},alphaTest:{value:0},uvTransform:{value:new Ue}},sprite:{diffuse:{value:new Ze(16777215)},opacity:{value:1},center:{value:new De(.5,.5)},rotation:{value:0},map:{value:null},mapTransform:{value:new Ue},alphaMap:{value:null},alphaMapTransform:{value:new Ue},alphaTest:{value:0}}},Ln={basic:{uniforms:kt([ve.common,ve.specularmap,ve.envmap,ve.aomap,ve.lightmap,ve.fog]),vertexShader:Ve.meshbasic_vert,fragmentShader:Ve.meshbasic_frag},lambert:{uniforms:kt([ve.common,ve.specularmap,ve.envmap,ve.aomap,ve.lightmap,ve.emissivemap,ve.bumpmap,ve.normalmap,ve.displacementmap,ve.fog,ve.lights,{emissive:{value:new Ze(0)},envMapIntensity:{value:1}}]),vertexShader:Ve.meshlambert_vert,fragmentShader:Ve.meshlambert_frag},phong:{uniforms:kt([ve.common,ve.specularmap,ve.envmap,ve.aomap,ve.lightmap,ve.emissivemap,ve.bumpmap,ve.normalmap,ve.displacementmap,ve.fog,ve.lights,{emissive:{value:new Ze(0)},specular:{value:new Ze(1118481)},shininess:{value:30},envMapIntensity:{value:1}}]),vertexShader:Ve.meshphong_vert,fragmentShader:Ve.meshphong_frag},standard:{uniforms:kt([ve.common,ve.envmap,ve.aomap,ve.lightmap,ve.emissivemap,ve.bumpmap,ve.normalmap,ve.displacementmap,ve.roughnessmap,ve.metalnessmap,ve.fog,ve.lights,{emissive:{value:new Ze(0)},roughness:{value:1},metalness:{value:0},envMapIntensity:{value:1}}]),vertexShader:Ve.meshphysical_vert,fragmentShader:Ve.meshphysical_frag},toon:{uniforms:kt([ve.common,ve.aomap,ve.lightmap,ve.emissivemap,ve.bumpmap,ve.normalmap,ve.displacementmap,ve.gradientmap,ve.fog,ve.lights,{emissive:{value:new Ze(0)}}]),vertexShader:Ve.meshtoon_vert,fragmentShader:Ve.meshtoon_frag},matcap:{uniforms:kt([ve.common,ve.bumpmap,ve.normalmap,ve.displacementmap,ve.fog,{matcap:{value:null}}]),vertexShader:Ve.meshmatcap_vert,fragmentShader:Ve.meshmatcap_frag},points:{uniforms:kt([ve.points,ve.fog]),vertexShader:Ve.points_vert,fragmentShader:Ve.points_frag},dashed:{uniforms:kt([ve.common,ve.fog,{scale:{value:1},dashSize:{value:1},totalSize:{value:2}}]),vertexShader:Ve.linedashed_vert,fragmentShader:Ve.linedashed_frag},depth:{uniforms:kt([ve.common,ve.displacementmap]),vertexShader:Ve.depth_vert,fragmentShader:Ve.depth_frag},normal:{uniforms:kt([ve.common,ve.bumpmap,ve.normalmap,ve.displacementmap,{opacity:{value:1}}]),vertexShader:Ve.meshnormal_vert,fragmentShader:Ve.meshnormal_frag},sprite:{uniforms:kt([ve.sprite,ve.fog]),vertexShader:Ve.sprite_vert,fragmentShader:Ve.sprite_frag},background:{uniforms:{uvTransform:{value:new Ue},t2D:{value:null},backgroundIntensity:{value:1}},vertexShader:Ve.background_vert,fragmentShader:Ve.background_frag},backgroundCube:{uniforms:{envMap:{value:null},backgroundBlurriness:{value:0},backgroundIntensity:{value:1},backgroundRotation:{value:new Ue}},vertexShader:Ve.backgroundCube_vert,fragmentShader:Ve.backgroundCube_frag},cube:{uniforms:{tCube:{value:null},tFlip:{value:-1},opacity:{value:1}},vertexShader:Ve.cube_vert,fragmentShader:Ve.cube_frag},equirect:{uniforms:{tEquirect:{value:null}},vertexShader:Ve.equirect_vert,fragmentShader:Ve.equirect_frag},distance:{uniforms:kt([ve.common,ve.displacementmap,{referencePosition:{value:new N},nearDistance:{value:1},farDistance:{value:1e3}}]),vertexShader:Ve.distance_vert,fragmentShader:Ve.distance_frag},shadow:{uniforms:kt([ve.lights,ve.fog,{color:{value:new Ze(0)},opacity:{value:1}}]),vertexShader:Ve.shadow_vert,fragmentShader:Ve.shadow_frag}};Ln.physical={uniforms:kt([Ln.standard.uniforms,{clearcoat:{value:0},clearcoatMap:{value:null},clearcoatMapTransform:{value:new Ue},clearcoatNormalMap:{value:null},clearcoatNormalMapTransform:{value:new Ue},clearcoatNormalScale:{value:new De(1,1)},clearcoatRoughness:{value:0},clearcoatRoughnessMap:{value:null},clearcoatRoughnessMapTransform:{value:new Ue},diffuseRoughness:{value:0},diffuseRoughnessMap:{value:null},diffuseRoughnessMapTransform:{value:new Ue},dispersion:{value:0},retroreflectivity:{value:0},iridescence:{value:0},iridescenceMap:{value:null},iridescenceMapTransform:{value:new Ue},iridescenceIOR:{value:1.3},iridescenceThicknessMinimum:{value:100},iridescenceThicknessMaximum:{value:400},iridescenceThicknessMap:{value:null},iridescenceThicknessMapTransform:{value:new Ue},sheen:{value:0},sheenColor:{value:new Ze(0)},sheenColorMap:{value:null},sheenColorMapTransform:{value:new Ue},sheenRoughness:{value:1},sheenRoughnessMap:{value:null},sheenRoughnessMapTransform:{value:new Ue},transmission:{value:0},transmissionMap:{value:null},transmissionMapTransform:{value:new Ue},transmissionSamplerSize:{value:new De},transmissionSamplerMap:{value:null},thickness:{value:0},thicknessMap:{value:null},thicknessMapTransform:{value:new Ue},attenuationDistance:{value:0},attenuationColor:{value:new Ze(0)},specularColor:{value:new Ze(1,1,1)},specularColorMap:{value:null},specularColorMapTransform:{value:new Ue},specularIntensity:{value:1},specularIntensityMap:{value:null},specularIntensityMapTransform:{value:new Ue},anisotropyVector:{value:new De},anisotropyMap:{value:null},anisotropyMapTransform:{value:new Ue}}]),vertexShader:Ve.meshphysical_vert,fragmentShader:Ve.meshphysical_frag};var da={r:0,b:0,g:0},Gg=new lt,Uu=new Ue;Uu.set(-1,0,0,0,1,0,0,0,1);function Vg(i,e,t,n,s,r){let o=new Ze(0),a=s===!0?0:1,l,c,h=null,d=0,u=null;function f(_){let R=_.isScene===!0?_.background:null;if(R&&R.isTexture){let w=_.backgroundBlurriness>0;R=e.get(R,w)}return R}function v(_){let R=!1,w=f(_);w===null?m(o,a):w&&w.isColor&&(m(w,1),R=!0);let T=i.xr.getEnvironmentBlendMode();T==="additive"?t.buffers.color.setClear(0,0,0,1,r):T==="alpha-blend"&&t.buffers.color.setClear(0,0,0,0,r),(i.autoClear||R)&&(t.buffers.depth.setTest(!0),t.buffers.depth.setMask(!0),t.buffers.color.setMask(!0),i.clear(i.autoClearColor,i.autoClearDepth,i.autoClearStencil))}function S(_,R){let w=f(R);w&&w.isCubeTexture?(c===void 0&&(c=new Ht(new os(1,1,1),new Tn({name:"BackgroundCubeMaterial",uniforms:Ui(Ln.backgroundCube.uniforms),vertexShader:Ln.backgroundCube.vertexShader,fragmentShader:Ln.backgroundCube.fragmentShader,side:Nt,depthTest:!1,depthWrite:!1,fog:!1,allowOverride:!1})),c.geometry.deleteAttribute("normal"),c.geometry.deleteAttribute("uv"),c.onBeforeRender=function(T,E,g){this.matrixWorld.copyPosition(g.matrixWorld)},Object.defineProperty(c.material,"envMap",{get:function(){return this.uniforms.envMap.value}}),n.update(c)),c.material.uniforms.envMap.value=w,c.material.uniforms.backgroundBlurriness.value=R.backgroundBlurriness,c.material.uniforms.backgroundIntensity.value=R.backgroundIntensity,c.material.uniforms.backgroundRotation.value.setFromMatrix4(Gg.makeRotationFromEuler(R.backgroundRotation)).transpose(),w.isRenderTargetTexture===!1&&c.material.uniforms.backgroundRotation.value.premultiply(Uu),c.material.toneMapped=Ye.getTransfer(w.colorSpace)!==Qe,(h!==w||d!==w.version||u!==i.toneMapping)&&(c.material.needsUpdate=!0,h=w,d=w.version,u=i.toneMapping),c.layers.enableAll(),_.unshift(c,c.geometry,c.material,0,0,null)):w&&w.isTexture&&(l===void 0&&(l=new Ht(new Xs(2,2),new Tn({name:"BackgroundMaterial",uniforms:Ui(Ln.background.uniforms),vertexShader:Ln.background.vertexShader,fragmentShader:Ln.background.fragmentShader,side:Rn,depthTest:!1,depthWrite:!1,fog:!1,allowOverride:!1})),l.geometry.deleteAttribute("normal"),Object.defineProperty(l.material,"map",{get:function(){return this.uniforms.t2D.value}}),n.update(l)),l.material.uniforms.t2D.value=w,l.material.uniforms.backgroundIntensity.value=R.backgroundIntensity,l.material.toneMapped=Ye.getTransfer(w.colorSpace)!==Qe,w.matrixAutoUpdate===!0&&w.updateMatrix(),l.material.uniforms.uvTransform.value.copy(w.matrix),(h!==w||d!==w.version||u!==i.toneMapping)&&(l.material.needsUpdate=!0,h=w,d=w.version,u=i.toneMapping),l.layers.enableAll(),_.unshift(l,l.geometry,l.material,0,0,null))}function m(_,R){_.getRGB(da,Wl(i)),t.buffers.color.setClear(da.r,da.g,da.b,R,r)}function p(){c!==void 0&&(c.geometry.dispose(),c.material.dispose(),c=void 0),l!==void 0&&(l.geometry.dispose(),l.material.dispose(),l=void 0)}return{getClearColor:function(){return o},setClearColor:function(_,R=1){o.set(_),a=R,m(o,a)},getClearAlpha:function(){return a},setClearAlpha:function(_){a=_,m(o,a)},render:v,addToRenderList:S,dispose:p}}function Hg(i,e){let t=i.getParameter(i.MAX_VERTEX_ATTRIBS),n={},s=u(null),r=s,o=!1;function a(D,G,$,P,q){let K=!1,V=d(D,P,$,G);r!==V&&(r=V,c(r.object)),K=f(D,P,$,q),K&&v(D,P,$,q),q!==null&&e.update(q,i.ELEMENT_ARRAY_BUFFER),(K||o)&&(o=!1,w(D,G,$,P),q!==null&&i.bindBuffer(i.ELEMENT_ARRAY_BUFFER,e.get(q).buffer))}function l(){return i.createVertexArray()}function c(D){return i.bindVertexArray(D)}function h(D){return i.deleteVertexArray(D)}function d(D,G,$,P){let q=P.wireframe===!0,K=n[G.id];K===void 0&&(K={},n[G.id]=K);let V=D.isInstancedMesh===!0?D.id:0,re=K[V];re===void 0&&(re={},K[V]=re);let X=re[$.id];X===void 0&&(X={},re[$.id]=X);let te=X[q];return te===void 0&&(te=u(l()),X[q]=te),te}function u(D){let G=[],$=[],P=[];for(let q=0;q<t;q++)G[q]=0,$[q]=0,P[q]=0;return{geometry:null,program:null,wireframe:!1,newAttributes:G,enabledAttributes:$,attributeDivisors:P,object:D,attributes:{},index:null}}function f(D,G,$,P){let q=r.attributes,K=G.attributes,V=0,re=$.getAttributes();for(let X in re)if(re[X].location>=0){let ie=q[X],Ee=K[X];if(Ee===void 0&&(X==="instanceMatrix"&&D.instanceMatrix&&(Ee=D.instanceMatrix),X==="instanceColor"&&D.instanceColor&&(Ee=D.instanceColor)),ie===void 0||ie.attribute!==Ee||Ee&&ie.data!==Ee.data)return!0;V++}return r.attributesNum!==V||r.index!==P}function v(D,G,$,P){let q={},K=G.attributes,V=0,re=$.getAttributes();for(let X in re)if(re[X].location>=0){let ie=K[X];ie===void 0&&(X==="instanceMatrix"&&D.instanceMatrix&&(ie=D.instanceMatrix),X==="instanceColor"&&D.instanceColor&&(ie=D.instanceColor));let Ee={};Ee.attribute=ie,ie&&ie.data&&(Ee.data=ie.data),q[X]=Ee,V++}r.attributes=q,r.attributesNum=V,r.index=P}function S(){let D=r.newAttributes;for(let G=0,$=D.length;G<$;G++)D[G]=0}function m(D){p(D,0)}function p(D,G){let $=r.newAttributes,P=r.enabledAttributes,q=r.attributeDivisors;$[D]=1,P[D]===0&&(i.enableVertexAttribArray(D),P[D]=1),q[D]!==G&&(i.vertexAttribDivisor(D,G),q[D]=G)}function _(){let D=r.newAttributes,G=r.enabledAttributes;for(let $=0,P=G.length;$<P;$++)G[$]!==D[$]&&(i.disableVertexAttribArray($),G[$]=0)}function R(D,G,$,P,q,K,V){V===!0?i.vertexAttribIPointer(D,G,$,q,K):i.vertexAttribPointer(D,G,$,P,q,K)}function w(D,G,$,P){S();let q=P.attributes,K=$.getAttributes(),V=G.defaultAttributeValues;for(let re in K){let X=K[re];if(X.location>=0){let te=q[re];if(te===void 0&&(re==="instanceMatrix"&&D.instanceMatrix&&(te=D.instanceMatrix),re==="instanceColor"&&D.instanceColor&&(te=D.instanceColor)),te!==void 0){let ie=te.normalized,Ee=te.itemSize,Fe=e.get(te);if(Fe===void 0)continue;let j=Fe.buffer,xe=Fe.type,be=Fe.bytesPerElement,Pe=xe===i.INT||xe===i.UNSIGNED_INT||te.gpuType===Po;if(te.isInterleavedBufferAttribute){let ye=te.data,ke=ye.isInterleavedBuffer===!0?ye.stride:ye.itemSize,pt=te.offset;if(ye.isInstancedInterleavedBuffer||ye.isInstancedBufferAttribute){for(let Ie=0;Ie<X.locationSize;Ie++)p(X.location+Ie,ye.meshPerAttribute);D.isInstancedMesh!==!0&&P.O===void 0&&(P.O=ye.meshPerAttribute*ye.count)}else for(let Ie=0;Ie<X.locationSize;Ie++)m(X.location+Ie);i.bindBuffer(i.ARRAY_BUFFER,j);for(let Ie=0;Ie<X.locationSize;Ie++)R(X.location+Ie,Ee/X.locationSize,xe,ie,ke*be,(pt+Ee/X.locationSize*Ie)*be,Pe)}else{if(te.isInstancedBufferAttribute){for(let ye=0;ye<X.locationSize;ye++)p(X.location+ye,te.meshPerAttribute);D.isInstancedMesh!==!0&&P.O===void 0&&(P.O=te.meshPerAttribute*te.count)}else for(let ye=0;ye<X.locationSize;ye++)m(X.location+ye);i.bindBuffer(i.ARRAY_BUFFER,j);for(let ye=0;ye<X.locationSize;ye++)R(X.location+ye,Ee/X.locationSize,xe,ie,Ee*be,Ee/X.locationSize*ye*be,Pe)}}else if(V!==void 0){let ie=V[re];if(ie!==void 0)switch(ie.length){case 2:i.vertexAttrib2fv(X.location,ie);break;case 3:i.vertexAttrib3fv(X.location,ie);break;case 4:i.vertexAttrib4fv(X.location,ie);break;default:i.vertexAttrib1fv(X.location,ie)}}}}_()}function T(){k();for(let D in n){let G=n[D];for(let $ in G){let P=G[$];for(let q in P){let K=P[q];for(let V in K)h(K[V].object),delete K[V];delete P[q]}}delete n[D]}}function E(D){if(n[D.id]===void 0)return;let G=n[D.id];for(let $ in G){let P=G[$];for(let q in P){let K=P[q];for(let V in K)h(K[V].object),delete K[V];delete P[q]}}delete n[D.id]}function g(D){for(let G in n){let $=n[G];for(let P in $){let q=$[P];if(q[D.id]===void 0)continue;let K=q[D.id];for(let V in K)h(K[V].object),delete K[V];delete q[D.id]}}}function b(D){for(let G in n){let $=n[G],P=D.isInstancedMesh===!0?D.id:0,q=$[P];if(q!==void 0){for(let K in q){let V=q[K];for(let re in V)h(V[re].object),delete V[re];delete q[K]}delete $[P],Object.keys($).length===0&&delete n[G]}}}function k(){L(),o=!0,r!==s&&(r=s,c(r.object))}function L(){s.geometry=null,s.program=null,s.wireframe=!1}return{setup:a,reset:k,resetDefaultState:L,dispose:T,releaseStatesOfGeometry:E,releaseStatesOfObject:b,releaseStatesOfProgram:g,initAttributes:S,enableAttribute:m,disableUnusedAttributes:_}}function Wg(i,e,t){let n;function s(l){n=l}function r(l,c){i.drawArrays(n,l,c),t.update(c,n,1)}function o(l,c,h){h!==0&&(i.drawArraysInstanced(n,l,c,h),t.update(c,n,h))}function a(l,c,h){if(h===0)return;e.get("WEBGL_multi_draw").multiDrawArraysWEBGL(n,l,0,c,0,h);let u=0;for(let f=0;f<h;f++)u+=c[f];t.update(u,n,1)}this.setMode=s,this.render=r,this.renderInstances=o,this.renderMultiDraw=a}function Xg(i,e,t,n){let s;function r(){if(s!==void 0)return s;if(e.has("EXT_texture_filter_anisotropic")===!0){let g=e.get("EXT_texture_filter_anisotropic");s=i.getParameter(g.MAX_TEXTURE_MAX_ANISOTROPY_EXT)}else s=0;return s}function o(g){return!(g!==bn&&n.convert(g)!==i.getParameter(i.IMPLEMENTATION_COLOR_READ_FORMAT))}function a(g){let b=g===Mn&&(e.has("EXT_color_buffer_half_float")||e.has("EXT_color_buffer_float"));return!(g!==sn&&g!==Sn&&!b&&n.convert(g)!==i.getParameter(i.IMPLEMENTATION_COLOR_READ_TYPE))}function l(g){if(g==="highp"){if(i.getShaderPrecisionFormat(i.VERTEX_SHADER,i.HIGH_FLOAT).precision>0&&i.getShaderPrecisionFormat(i.FRAGMENT_SHADER,i.HIGH_FLOAT).precision>0)return"highp";g="mediump"}return g==="mediump"&&i.getShaderPrecisionFormat(i.VERTEX_SHADER,i.MEDIUM_FLOAT).precision>0&&i.getShaderPrecisionFormat(i.FRAGMENT_SHADER,i.MEDIUM_FLOAT).precision>0?"mediump":"lowp"}let c=t.precision!==void 0?t.precision:"highp",h=l(c);h!==c&&(Ce("WebGLRenderer:",c,"not supported, using",h,"instead."),c=h);let d=t.reversedDepthBuffer===!0&&e.has("EXT_clip_control"),u=t.logarithmicDepthBuffer===!0&&d===!1;t.reversedDepthBuffer===!0&&d===!1&&Ce("WebGLRenderer: Unable to use reversed depth buffer due to missing EXT_clip_control extension. Fallback to default depth buffer."),t.logarithmicDepthBuffer===!0&&d===!0&&Ce("WebGLRenderer: Logarithmic depth buffer is ignored when reversed depth buffer is enabled.");let f=i.getParameter(i.MAX_TEXTURE_IMAGE_UNITS),v=i.getParameter(i.MAX_VERTEX_TEXTURE_IMAGE_UNITS),S=i.getParameter(i.MAX_TEXTURE_SIZE),m=i.getParameter(i.MAX_CUBE_MAP_TEXTURE_SIZE),p=i.getParameter(i.MAX_VERTEX_ATTRIBS),_=i.getParameter(i.MAX_VERTEX_UNIFORM_VECTORS),R=i.getParameter(i.MAX_VARYING_VECTORS),w=i.getParameter(i.MAX_FRAGMENT_UNIFORM_VECTORS),T=i.getParameter(i.MAX_SAMPLES),E=i.getParameter(i.SAMPLES);return{isWebGL2:!0,getMaxAnisotropy:r,getMaxPrecision:l,textureFormatReadable:o,textureTypeReadable:a,precision:c,logarithmicDepthBuffer:u,reversedDepthBuffer:d,maxTextures:f,maxVertexTextures:v,maxTextureSize:S,maxCubemapSize:m,maxAttributes:p,maxVertexUniforms:_,maxVaryings:R,maxFragmentUniforms:w,maxSamples:T,samples:E}}function qg(i){let e=this,t=null,n=0,s=!1,r=!1,o=new Qt,a=new Ue,l={value:null,needsUpdate:!1};this.uniform=l,this.numPlanes=0,this.numIntersection=0,this.init=function(d,u){let f=d.length!==0||u||n!==0||s;return s=u,n=d.length,f},this.beginShadows=function(){r=!0,h(null)},this.endShadows=function(){r=!1},this.setGlobalState=function(d,u){t=h(d,u,0)},this.setState=function(d,u,f){let v=d.clippingPlanes,S=d.clipIntersection,m=d.clipShadows,p=i.get(d);if(!s||v===null||v.length===0||r&&!m)r?h(null):c();else{let _=r?0:n,R=_*4,w=p.clippingState||null;l.value=w,w=h(v,u,R,f);for(let T=0;T!==R;++T)w[T]=t[T];p.clippingState=w,this.numIntersection=S?this.numPlanes:0,this.numPlanes+=_}};function c(){l.value!==t&&(l.value=t,l.needsUpdate=n>0),e.numPlanes=n,e.numIntersection=0}function h(d,u,f,v){let S=d!==null?d.length:0,m=null;if(S!==0){if(m=l.value,v!==!0||m===null){let p=f+S*4,_=u.matrixWorldInverse;a.getNormalMatrix(_),(m===null||m.length<p)&&(m=new Float32Array(p));for(let R=0,w=f;R!==S;++R,w+=4)o.copy(d[R]).applyMatrix4(_,a),o.normal.toArray(m,w),m[w+3]=o.constant}l.value=m,l.needsUpdate=!0}return e.numPlanes=S,e.numIntersection=0,m}}var rr=class extends tn{constructor(e=1,t={}){super(e,e,t),this.isWebGLCubeRenderTarget=!0;let n={width:e,height:e,depth:1},s=[n,n,n,n,n,n];this.texture=new Vs(s),this.$e(t),this.texture.isRenderTargetTexture=!0}fromEquirectangularTexture(e,t){this.texture.type=t.type,this.texture.colorSpace=t.colorSpace,this.texture.generateMipmaps=t.generateMipmaps,this.texture.minFilter=t.minFilter,this.texture.magFilter=t.magFilter;let n={uniforms:{tEquirect:{value:null}},vertexShader:`

varying vec3 vWorldDirection;

vec3 transformDirection( in vec3 dir, in mat4 matrix ) {

return normalize( ( matrix * vec4( dir, 0.0 ) ).xyz );

}

void main() {

vWorldDirection = transformDirection( position, modelMatrix );

#include <begin_vertex>
#include <project_vertex>

}
`,fragmentShader:`

uniform sampler2D tEquirect;

varying vec3 vWorldDirection;

#include <common>

void main() {

vec3 direction = normalize( vWorldDirection );

vec2 sampleUV = equirectUv( direction );

gl_FragColor = texture2D( tEquirect, sampleUV );

}
`},s=new os(5,5,5),r=new Tn({name:"CubemapFromEquirect",uniforms:Ui(n.uniforms),vertexShader:n.vertexShader,fragmentShader:n.fragmentShader,side:Nt,blending:Pi});r.uniforms.tEquirect.value=t;let o=new Ht(s,r),a=t.minFilter;return t.minFilter===qn&&(t.minFilter=Vt),new as(1,10,this).update(e,o),t.minFilter=a,o.geometry.dispose(),o.material.dispose(),this}clear(e,t=!0,n=!0,s=!0){let r=e.getRenderTarget();for(let o=0;o<6;o++)e.setRenderTarget(this,o),e.clear(t,n,s);e.setRenderTarget(r)}},fu=256,Yg=3,$g=20,Ou=256,Fu=16,Zg=3,jg=new N,Jg=new Ze,pa=class i{constructor(e){this.an=e,this.Rt=0,this.pe=null,this.ii=new as(1,10,null),this.Ct=new Ht(new os(5,5,5),null),this.me=null,this.ge=null,this.ct=null,this.Be=null,this.ht=null}fromScene(e,t=0,n=.1,s=100,r={}){let{size:o=256,position:a=jg}=r,l=this.an;this.ln(o);let c=this.si(),h=this.ri(!0);t>0&&(h.texture.mipmapsAutoUpdate=!1);let d=l.autoClear,u=l.autoClearColor,f=l.autoClearDepth,v=l.autoClearStencil,S=e.background;l.autoClear=!0,l.autoClearColor=!0,l.autoClearDepth=!0,l.autoClearStencil=!0,S===null&&(e.background=l.getClearColor(Jg));let m=new as(n,s,h);return m.position.copy(a),m.update(l,e),l.autoClear=d,l.autoClearColor=u,l.autoClearDepth=f,l.autoClearStencil=v,e.background=S,t>0&&(h.texture.mipmapsAutoUpdate=!0,this.Cs(c,t)),this.oi(c),c}fromEquirectangular(e,t=null){return this.ai(e,t)}fromCubemap(e,t=null){return this.ai(e,t)}compileCubemapShader(){this.me===null&&(this.me=gu(),this.li(this.me))}compileEquirectangularShader(){this.ge===null&&(this.ge=mu(),this.li(this.ge))}dispose(){this.pe!==null&&this.pe.dispose(),this.me!==null&&this.me.dispose(),this.ge!==null&&this.ge.dispose(),this.ct!==null&&this.ct.dispose(),this.Be!==null&&this.Be.dispose(),this.ht!==null&&this.ht.dispose(),this.Ct.geometry.dispose()}static lodToRoughness(e,t){return t>0?1-Math.sqrt(1-e/t):0}ln(e){this.Rt=Math.max(fu,Gl(e))}ai(e,t){e.mapping===Ii||e.mapping===us?this.ln(e.image.length===0?fu:e.image[0].width||e.image[0].image.width):this.ln(e.image.width/4);let n=t||this.si();return this.Ps(e),this.oi(n),n}si(){let e=this.Rt,t=pu(e,!1,!1),n=Math.log2(e)-Yg;for(let s=0;s<=n;s++)t.texture.mipmaps.push({width:e>>s,height:e>>s});return t.texture.name="PMREM",t.texture.isPMREMTexture=!0,t}ri(e=!1){let t=this.Rt,n=this.pe;return(n===null||n.width!==t||e&&n.depthBuffer===!1)&&(n!==null&&n.dispose(),this.pe=pu(t,!0,e)),this.pe}li(e){this.Ct.material=e,this.an.compile(this.Ct,this.ii.children[0])}ut(e,t,n){let s=this.Ct,r=this.ii;s.material=n,r.renderTarget=e,r.activeMipmapLevel=t;let o=e.width>>t;e.viewport.set(0,0,o,o),r.update(this.an,s),e.viewport.set(0,0,e.width,e.height)}Ps(e){let t;e.mapping===Ii||e.mapping===us?(this.me===null&&(this.me=gu()),t=this.me,t.uniforms.flipEnvMap.value=e.isRenderTargetTexture===!1?-1:1):(this.ge===null&&(this.ge=mu()),t=this.ge),t.uniforms.envMap.value=e,this.ut(this.ri(),0,t)}oi(e){this.Be===null&&(this.Be=Kg(),this.ht=Qg());let t=this.Rt,n=e.texture.mipmaps.length-1,s=this.Be.uniforms;s.envMap.value=this.pe.texture;let r=this.ht.uniforms;r.envMap.value=this.pe.texture,r.sourceLod.value=Math.log2(t/Fu);for(let o=0;o<=n;o++){let a=i.lodToRoughness(o,n);if(o>n-Zg)r.roughness.value=a,this.ut(e,o,this.ht);else{let l=a>0?Math.log2(t)+.5*Math.log2(6/(Ou*Math.pow(a,4)))+.5:0;s.roughness.value=a,s.lodBias.value=l,this.ut(e,o,this.Be)}}}Cs(e,t){this.ct===null&&(this.ct=e0());let n=this.ct,s=n.uniforms,r=this.pe;s.sigma.value=Math.min(t,Math.PI)/Math.SQRT2,s.envMap.value=r.texture,this.ut(e,0,n),s.envMap.value=e.texture,this.ut(r,0,n)}};function pu(i,e,t){return new rr(i,{minFilter:qn,generateMipmaps:e,type:Mn,colorSpace:Ls,depthBuffer:t})}function or(i,e,t){return new Tn({name:i,uniforms:e,vertexShader:Ve.cube_vert,fragmentShader:t,side:Nt,blending:Pi,depthTest:!1,depthWrite:!1})}function Kg(){return or("PMREMGGXConvolution",{envMap:{value:null},roughness:{value:0},lodBias:{value:0}},`

#define GGX_SAMPLES ${Ou}u

varying vec3 vWorldDirection;

uniform samplerCube envMap;
uniform float roughness;
uniform float lodBias;

#include <common>

float radicalInverse_VdC( uint bits ) {

bits = ( bits << 16u ) | ( bits >> 16u );
bits = ( ( bits & 0x55555555u ) << 1u ) | ( ( bits & 0xAAAAAAAAu ) >> 1u );
bits = ( ( bits & 0x33333333u ) << 2u ) | ( ( bits & 0xCCCCCCCCu ) >> 2u );
bits = ( ( bits & 0x0F0F0F0Fu ) << 4u ) | ( ( bits & 0xF0F0F0F0u ) >> 4u );
bits = ( ( bits & 0x00FF00FFu ) << 8u ) | ( ( bits & 0xFF00FF00u ) >> 8u );
return float( bits ) * 2.3283064365386963e-10; // / 0x100000000

}

vec2 hammersley( uint i, uint N ) {

return vec2( float( i ) / float( N ), radicalInverse_VdC( i ) );

}

void main() {

vec3 N = normalize( vWorldDirection );

if ( roughness < 0.001 ) {

gl_FragColor = vec4( textureLod( envMap, N, 0.0 ).rgb, 1.0 );
return;

}

float alpha = roughness * roughness;
float alpha2 = alpha * alpha;

vec3 up = abs( N.z ) < 0.999 ? vec3( 0.0, 0.0, 1.0 ) : vec3( 1.0, 0.0, 0.0 );
vec3 tangent = normalize( cross( up, N ) );
vec3 bitangent = cross( N, tangent );

vec3 prefilteredColor = vec3( 0.0 );
float totalWeight = 0.0;

for ( uint i = 0u; i < GGX_SAMPLES; i ++ ) {

vec2 Xi = hammersley( i, GGX_SAMPLES );

float invQ = 1.0 / ( 1.0 - Xi.x + alpha2 * Xi.x );
float NdotL = ( 1.0 - Xi.x - alpha2 * Xi.x ) * invQ;

if ( NdotL > 0.0 ) {

float phi = 2.0 * PI * Xi.y;
float sinTheta = 2.0 * alpha * sqrt( Xi.x * ( 1.0 - Xi.x ) ) * invQ;
vec3 L = N * NdotL + ( tangent * cos( phi ) + bitangent * sin( phi ) ) * sinTheta;

float d = alpha2 * invQ;
float lod = max( log2( d ) + lodBias, 0.0 );

prefilteredColor += textureLod( envMap, L, lod ).rgb * NdotL;
totalWeight += NdotL;

}

}

gl_FragColor = vec4( prefilteredColor / totalWeight, 1.0 );

}
`)}function Qg(){return or("PMREMGGXIntegration",{envMap:{value:null},roughness:{value:0},sourceLod:{value:0},sourceSize:{value:Fu}},`

varying vec3 vWorldDirection;

uniform samplerCube envMap;
uniform float roughness;
uniform float sourceLod;
uniform int sourceSize;

void main() {

vec3 N = normalize( vWorldDirection );

float alpha = roughness * roughness;
float alpha2 = alpha * alpha;

float texelSize = 2.0 / float( sourceSize );

vec3 prefilteredColor = vec3( 0.0 );
float totalWeight = 0.0;

for ( int face = 0; face < 3; face ++ ) {

for ( int y = 0; y < sourceSize; y ++ ) {

for ( int x = 0; x < sourceSize; x ++ ) {

vec2 uv = ( vec2( x, y ) + 0.5 ) * texelSize - 1.0;
vec3 texelDirection = face == 0 ? vec3( 1.0, uv ) : ( face == 1 ? vec3( uv.x, 1.0, uv.y ) : vec3( uv, 1.0 ) );

float invDistance = inversesqrt( 1.0 + dot( uv, uv ) );
float NdotL = dot( N, texelDirection );
texelDirection *= NdotL < 0.0 ? - 1.0 : 1.0;
NdotL = abs( NdotL ) * invDistance;

float d = 1.0 + alpha2 + ( alpha2 - 1.0 ) * NdotL;
float weight = NdotL * invDistance * invDistance * invDistance / ( d * d );

prefilteredColor += textureLod( envMap, texelDirection, sourceLod ).rgb * weight;
totalWeight += weight;

}

}

}

gl_FragColor = vec4( prefilteredColor / totalWeight, 1.0 );

}
`)}function e0(){return or("PMREMSphericalGaussianBlur",{envMap:{value:null},sigma:{value:0}},`

#define SAMPLES ${$g}
#define GOLDEN_ANGLE 2.39996322973

varying vec3 vWorldDirection;

uniform samplerCube envMap;
uniform float sigma;

#include <common>

void main() {

vec3 outputDirection = normalize( vWorldDirection );

vec3 up = abs( outputDirection.z ) < 0.999 ? vec3( 0.0, 0.0, 1.0 ) : vec3( 1.0, 0.0, 0.0 );
vec3 tangent = normalize( cross( up, outputDirection ) );
vec3 bitangent = cross( outputDirection, tangent );

float thetaMax = min( 3.0 * sigma, PI );
float truncation = 1.0 - exp( - 0.5 * thetaMax * thetaMax / ( sigma * sigma ) );

vec3 accumColor = vec3( 0.0 );
float accumWeight = 0.0;

for ( int i = 0; i < SAMPLES; i ++ ) {

float stratum = ( float( i ) + 0.5 ) / float( SAMPLES );
float theta = sigma * sqrt( - 2.0 * log( 1.0 - stratum * truncation ) );
float phi = float( i ) * GOLDEN_ANGLE;

vec3 offset = cos( phi ) * tangent + sin( phi ) * bitangent;
vec3 sampleDirection = cos( theta ) * outputDirection + sin( theta ) * offset;

float weight = sin( theta ) / theta;

accumColor += weight * textureLod( envMap, sampleDirection, 0.0 ).rgb;
accumWeight += weight;

}

gl_FragColor = vec4( accumColor / accumWeight, 1.0 );

}
`)}function mu(){return or("PMREMEquirectangularToCubemap",{envMap:{value:null}},`

varying vec3 vWorldDirection;

uniform sampler2D envMap;

#include <common>

void main() {

vec3 direction = normalize( vWorldDirection );
vec3 dx = dFdx( direction ) * 0.25;
vec3 dy = dFdy( direction ) * 0.25;

vec3 color = textureLod( envMap, equirectUv( normalize( direction - dx - dy ) ), 0.0 ).rgb;
color += textureLod( envMap, equirectUv( normalize( direction + dx - dy ) ), 0.0 ).rgb;
color += textureLod( envMap, equirectUv( normalize( direction - dx + dy ) ), 0.0 ).rgb;
color += textureLod( envMap, equirectUv( normalize( direction + dx + dy ) ), 0.0 ).rgb;
gl_FragColor = vec4( color * 0.25, 1.0 );

}
`)}function gu(){return or("PMREMCubemapToCubemap",{envMap:{value:null},flipEnvMap:{value:-1}},`

varying vec3 vWorldDirection;

uniform samplerCube envMap;
uniform float flipEnvMap;

void main() {

gl_FragColor = vec4( textureCube( envMap, vec3( flipEnvMap * vWorldDirection.x, vWorldDirection.yz ) ).rgb, 1.0 );

}
`)}function t0(i){let e=new WeakMap,t=new WeakMap,n=null;function s(u,f=!1){return u==null?null:f?o(u):r(u)}function r(u){if(u&&u.isTexture){let f=u.mapping;if(f===To||f===Ro)if(e.has(u)){let v=e.get(u).texture;return a(v,u.mapping)}else{let v=u.image;if(v&&v.height>0){let S=new rr(v.height);return S.fromEquirectangularTexture(i,u),e.set(u,S),u.addEventListener("dispose",c),a(S.texture,u.mapping)}else return null}}return u}function o(u){if(u&&u.isTexture&&u.isPMREMTexture!==!0){let f=u.mapping,v=f===To||f===Ro,S=f===Ii||f===us;if(v||S){let m=t.get(u),p=m!==void 0?m.texture.pmremVersion:0;if(u.isRenderTargetTexture&&u.pmremVersion!==p)return n===null&&(n=new pa(i)),m=v?n.fromEquirectangular(u,m):n.fromCubemap(u,m),m.texture.pmremVersion=u.pmremVersion,t.set(u,m),m.texture;if(m!==void 0)return m.texture;{let _=u.image;return v&&_&&_.height>0||S&&_&&l(_)?(n===null&&(n=new pa(i)),m=v?n.fromEquirectangular(u):n.fromCubemap(u),m.texture.pmremVersion=u.pmremVersion,t.set(u,m),u.addEventListener("dispose",h),m.texture):null}}}return u}function a(u,f){return f===To?u.mapping=Ii:f===Ro&&(u.mapping=us),u}function l(u){let f=0,v=6;for(let S=0;S<v;S++)u[S]!==void 0&&f++;return f===v}function c(u){let f=u.target;f.removeEventListener("dispose",c);let v=e.get(f);v!==void 0&&(e.delete(f),v.dispose())}function h(u){let f=u.target;f.removeEventListener("dispose",h);let v=t.get(f);v!==void 0&&(t.delete(f),v.dispose())}function d(){e=new WeakMap,t=new WeakMap,n!==null&&(n.dispose(),n=null)}return{get:s,dispose:d}}function n0(i){let e={};function t(n){if(e[n]!==void 0)return e[n];let s=i.getExtension(n);return e[n]=s,s}return{has:function(n){return t(n)!==null},init:function(){t("EXT_color_buffer_float"),t("WEBGL_clip_cull_distance"),t("OES_texture_float_linear"),t("EXT_color_buffer_half_float"),t("WEBGL_multisampled_render_to_texture"),t("WEBGL_render_shared_exponent")},get:function(n){let s=t(n);return s===null&&Ts("WebGLRenderer: "+n+" extension not supported."),s}}}function i0(i,e,t,n){let s={},r=new WeakMap,o=new FinalizationRegistry(v=>delete s[v]);function a(v){l(v.target)}function l(v){v.index!==null&&e.remove(v.index);for(let m in v.attributes)e.remove(v.attributes[m]);v.removeEventListener("dispose",a),delete s[v.id],o.unregister(v);let S=r.get(v);S&&(e.remove(S),r.delete(v)),n.releaseStatesOfGeometry(v),v.isInstancedBufferGeometry===!0&&delete v.O,t.memory.geometries--}function c(v,S){return s[S.id]!==void 0||(S.addEventListener("dispose",a),s[S.id]=new WeakRef(S),o.register(S,S.id,S),t.memory.geometries++),S}function h(v){let S=v.attributes;for(let m in S)e.update(S[m],i.ARRAY_BUFFER)}function d(v){let S=v.index,m=v.attributes.position,p=0;if(m===void 0)return;let _=S!==null?S.array.length:m.array.length/3-1,R=m.count>=65535?ks:Bs,w=new R(Math.ceil(_/3)*6,1),T=w.array;if(S!==null){let g=S.array;p=S.version;for(let b=0,k=0;b<_;b+=3){let L=g[b+0],D=g[b+1],G=g[b+2];T[k++]=L,T[k++]=D,T[k++]=D,T[k++]=G,T[k++]=G,T[k++]=L}}else{p=m.version;for(let g=0,b=0;g<_;g+=3){let k=g+0,L=g+1,D=g+2;T[b++]=k,T[b++]=L,T[b++]=L,T[b++]=D,T[b++]=D,T[b++]=k}}w.version=p;let E=r.get(v);E&&e.remove(E),r.set(v,w)}function u(v){let S=r.get(v);if(S){let m=v.index;m!==null&&S.version<m.version&&d(v)}else d(v);return r.get(v)}function f(){for(let v in s){let S=s[v].deref();S!==void 0&&l(S)}}return{get:c,update:h,getWireframeAttribute:u,dispose:f}}function s0(i,e,t){let n;function s(d){n=d}let r,o;function a(d){r=d.type,o=d.bytesPerElement}function l(d,u){i.drawElements(n,u,r,d*o),t.update(u,n,1)}function c(d,u,f){f!==0&&(i.drawElementsInstanced(n,u,r,d*o,f),t.update(u,n,f))}function h(d,u,f){if(f===0)return;e.get("WEBGL_multi_draw").multiDrawElementsWEBGL(n,u,0,r,d,0,f);let S=0;for(let m=0;m<f;m++)S+=u[m];t.update(S,n,1)}this.setMode=s,this.setIndex=a,this.render=l,this.renderInstances=c,this.renderMultiDraw=h}function r0(i){let e={geometries:0,textures:0},t={frame:0,calls:0,triangles:0,points:0,lines:0};function n(r,o,a){switch(t.calls++,o){case i.TRIANGLES:t.triangles+=a*(r/3);break;case i.LINES:t.lines+=a*(r/2);break;case i.LINE_STRIP:t.lines+=a*(r-1);break;case i.LINE_LOOP:t.lines+=a*r;break;case i.POINTS:t.points+=a*r;break;default:Ne("WebGLInfo: Unknown draw mode:",o);break}}function s(){t.calls=0,t.triangles=0,t.points=0,t.lines=0}return{memory:e,render:t,programs:null,autoReset:!0,reset:s,update:n}}function o0(i,e,t){let n=new WeakMap,s=new dt;function r(o,a,l){let c=o.morphTargetInfluences,h=a.morphAttributes.position||a.morphAttributes.normal||a.morphAttributes.color,d=h!==void 0?h.length:0,u=n.get(a);if(u===void 0||u.count!==d){let k=function(){g.dispose(),n.delete(a),a.removeEventListener("dispose",k)};u!==void 0&&u.texture.dispose();let f=a.morphAttributes.position!==void 0,v=a.morphAttributes.normal!==void 0,S=a.morphAttributes.color!==void 0,m=a.morphAttributes.position||[],p=a.morphAttributes.normal||[],_=a.morphAttributes.color||[],R=0;f===!0&&(R=1),v===!0&&(R=2),S===!0&&(R=3);let w=a.attributes.position.count*R,T=1;w>e.maxTextureSize&&(T=Math.ceil(w/e.maxTextureSize),w=e.maxTextureSize);let E=new Float32Array(w*T*4*d),g=new Us(E,w,T,d);g.type=Sn,g.needsUpdate=!0;let b=R*4;for(let L=0;L<d;L++){let D=m[L],G=p[L],$=_[L],P=w*T*4*L;for(let q=0;q<D.count;q++){let K=q*b;f===!0&&(s.fromBufferAttribute(D,q),E[P+K+0]=s.x,E[P+K+1]=s.y,E[P+K+2]=s.z,E[P+K+3]=0),v===!0&&(s.fromBufferAttribute(G,q),E[P+K+4]=s.x,E[P+K+5]=s.y,E[P+K+6]=s.z,E[P+K+7]=0),S===!0&&(s.fromBufferAttribute($,q),E[P+K+8]=s.x,E[P+K+9]=s.y,E[P+K+10]=s.z,E[P+K+11]=$.itemSize===4?s.w:1)}}u={count:d,texture:g,size:new De(w,T)},n.set(a,u),a.addEventListener("dispose",k)}if(o.isInstancedMesh===!0&&o.morphTexture!==null)l.getUniforms().setValue(i,"morphTexture",o.morphTexture,t);else{let f=0;for(let S=0;S<c.length;S++)f+=c[S];let v=a.morphTargetsRelative?1:1-f;l.getUniforms().setValue(i,"morphTargetBaseInfluence",v),l.getUniforms().setValue(i,"morphTargetInfluences",c)}l.getUniforms().setValue(i,"morphTargetsTexture",u.texture,t),l.getUniforms().setValue(i,"morphTargetsTextureSize",u.size)}return{update:r}}function a0(i,e,t,n,s){let r=new WeakMap;function o(c){let h=s.render.frame,d=c.geometry,u=e.get(c,d);if(r.get(u)!==h&&(e.update(u),r.set(u,h)),c.isInstancedMesh&&(c.hasEventListener("dispose",l)===!1&&c.addEventListener("dispose",l),r.get(c)!==h&&(t.update(c.instanceMatrix,i.ARRAY_BUFFER),c.instanceColor!==null&&t.update(c.instanceColor,i.ARRAY_BUFFER),r.set(c,h))),c.isSkinnedMesh){let f=c.skeleton;r.get(f)!==h&&(f.update(),r.set(f,h))}return u}function a(){r=new WeakMap}function l(c){let h=c.target;h.removeEventListener("dispose",l),n.releaseStatesOfObject(h),t.remove(h.instanceMatrix),h.instanceColor!==null&&t.remove(h.instanceColor)}return{update:o,dispose:a}}var l0={[Sl]:"LINEAR_TONE_MAPPING",[Ml]:"REINHARD_TONE_MAPPING",[bl]:"CINEON_TONE_MAPPING",[_l]:"ACES_FILMIC_TONE_MAPPING",[El]:"AGX_TONE_MAPPING",[Al]:"NEUTRAL_TONE_MAPPING",[wl]:"CUSTOM_TONE_MAPPING"};function c0(i,e,t,n,s,r){let o=new tn(e,t,{type:i,depthBuffer:s,stencilBuffer:r,samples:n?4:0,storeMultisampledDepthBuffer:!1,storeMultisampledStencilBuffer:!1,resolveDepthBuffer:!1,resolveStencilBuffer:!1}),a=null,l=null,c=null,h=new It;h.setAttribute("position",new qt([-1,3,0,-1,-1,0,3,-1,0],3)),h.setAttribute("uv",new qt([0,2,0,0,2,0],2));let d=new di({uniforms:{tDiffuse:{value:null}},vertexShader:`
precision highp float;

uniform mat4 modelViewMatrix;
uniform mat4 projectionMatrix;

attribute vec3 position;
attribute vec2 uv;

varying vec2 vUv;

void main() {
vUv = uv;
gl_Position = projectionMatrix * modelViewMatrix * vec4( position, 1.0 );
}`,fragmentShader:`
precision highp float;

uniform sampler2D tDiffuse;

varying vec2 vUv;

#include <tonemapping_pars_fragment>
#include <colorspace_pars_fragment>

void main() {
gl_FragColor = texture2D( tDiffuse, vUv );

#ifdef LINEAR_TONE_MAPPING
gl_FragColor.rgb = LinearToneMapping( gl_FragColor.rgb );
#elif defined( REINHARD_TONE_MAPPING )
gl_FragColor.rgb = ReinhardToneMapping( gl_FragColor.rgb );
#elif defined( CINEON_TONE_MAPPING )
gl_FragColor.rgb = CineonToneMapping( gl_FragColor.rgb );
#elif defined( ACES_FILMIC_TONE_MAPPING )
gl_FragColor.rgb = ACESFilmicToneMapping( gl_FragColor.rgb );
#elif defined( AGX_TONE_MAPPING )
gl_FragColor.rgb = AgXToneMapping( gl_FragColor.rgb );
#elif defined( NEUTRAL_TONE_MAPPING )
gl_FragColor.rgb = NeutralToneMapping( gl_FragColor.rgb );
#elif defined( CUSTOM_TONE_MAPPING )
gl_FragColor.rgb = CustomToneMapping( gl_FragColor.rgb );
#endif

#ifdef SRGB_TRANSFER
gl_FragColor = sRGBTransferOETF( gl_FragColor );
#endif
}`,depthTest:!1,depthWrite:!1}),u=new Ht(h,d),f=new Eo(-1,1,1,-1,0,1),v=null,S=null,m=!1,p,_=null,R=[],w=!1;this.setSize=function(T,E){o.setSize(T,E),a!==null&&a.setSize(T,E),l!==null&&l.setSize(T,E);for(let g=0;g<R.length;g++){let b=R[g];b.setSize&&b.setSize(T,E)}},this.setEffects=function(T){R=T,w=R.length>0&&R[0].isRenderPass===!0;let E=o.width,g=o.height;R.length>0&&a===null&&(a=new tn(E,g,{type:Mn,depthBuffer:!1,stencilBuffer:!1}),l=new tn(E,g,{type:Mn,depthBuffer:!1,stencilBuffer:!1}));let b=s===!0&&R.some(k=>k.needsDepthTexture===!0);b!==(o.depthTexture!==null)&&(b===!0&&c===null&&(c=new Xn(E,g),r===!0&&(c.format=Yn,c.type=Ni)),o.dispose(),o.depthTexture=b?c:null,o.resolveDepthBuffer=b,o.storeMultisampledDepthBuffer=b);for(let k=0;k<R.length;k++){let L=R[k];L.setSize&&L.setSize(E,g),b&&L.needsDepthTexture===!0&&L.setDepthTexture&&L.setDepthTexture(c)}},this.begin=function(T,E){if(m||T.toneMapping===Cn&&R.length===0)return!1;if(_=E,E!==null){let g=E.width,b=E.height;(o.width!==g||o.height!==b)&&this.setSize(g,b)}return w===!1&&T.setRenderTarget(o),p=T.toneMapping,T.toneMapping=Cn,!0},this.hasRenderPass=function(){return w},this.end=function(T,E){T.toneMapping=p,m=!0;let g=o,b=a;for(let k=0;k<R.length;k++){let L=R[k];L.enabled!==!1&&(L.render(T,b,g,E),L.needsSwap!==!1&&(g=b,b=b===a?l:a))}if(v!==T.outputColorSpace||S!==T.toneMapping){v=T.outputColorSpace,S=T.toneMapping,d.defines={},Ye.getTransfer(v)===Qe&&(d.defines.SRGB_TRANSFER="");let k=l0[S];k&&(d.defines[k]=""),d.needsUpdate=!0}d.uniforms.tDiffuse.value=g.texture,T.setRenderTarget(_),T.render(u,f),_=null,m=!1},this.isCompositing=function(){return m},this.dispose=function(){o.dispose(),a!==null&&a.dispose(),l!==null&&l.dispose(),h.dispose(),d.dispose()}}var Bu=new Yt,ku=new Xn(1,1),zu=new Hs(1),Gu=new Us,Vu=new so,Hu=new Vs,vu=[],xu=[],yu=new Float32Array(16),Su=new Float32Array(9),Mu=new Float32Array(4);function ms(i,e,t){let n=i[0];if(n<=0||n>0)return i;let s=e*t,r=vu[s];if(r===void 0&&(r=new Float32Array(s),vu[s]=r),e!==0){n.toArray(r,0);for(let o=1,a=0;o!==e;++o)a+=t,i[o].toArray(r,a)}return r}function yt(i,e){if(i.length!==e.length)return!1;for(let t=0,n=i.length;t<n;t++)if(i[t]!==e[t])return!1;return!0}function St(i,e){for(let t=0,n=e.length;t<n;t++)i[t]=e[t]}function ga(i,e){let t=xu[e];t===void 0&&(t=new Int32Array(e),xu[e]=t);for(let n=0;n!==e;++n)t[n]=i.allocateTextureUnit();return t}function h0(i,e){let t=this.cache;t[0]!==e&&(i.uniform1f(this.addr,e),t[0]=e)}function u0(i,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y)&&(i.uniform2f(this.addr,e.x,e.y),t[0]=e.x,t[1]=e.y);else{if(yt(t,e))return;i.uniform2fv(this.addr,e),St(t,e)}}function d0(i,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y||t[2]!==e.z)&&(i.uniform3f(this.addr,e.x,e.y,e.z),t[0]=e.x,t[1]=e.y,t[2]=e.z);else if(e.r!==void 0)(t[0]!==e.r||t[1]!==e.g||t[2]!==e.b)&&(i.uniform3f(this.addr,e.r,e.g,e.b),t[0]=e.r,t[1]=e.g,t[2]=e.b);else{if(yt(t,e))return;i.uniform3fv(this.addr,e),St(t,e)}}function f0(i,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y||t[2]!==e.z||t[3]!==e.w)&&(i.uniform4f(this.addr,e.x,e.y,e.z,e.w),t[0]=e.x,t[1]=e.y,t[2]=e.z,t[3]=e.w);else{if(yt(t,e))return;i.uniform4fv(this.addr,e),St(t,e)}}function p0(i,e){let t=this.cache,n=e.elements;if(n===void 0){if(yt(t,e))return;i.uniformMatrix2fv(this.addr,!1,e),St(t,e)}else{if(yt(t,n))return;Mu.set(n),i.uniformMatrix2fv(this.addr,!1,Mu),St(t,n)}}function m0(i,e){let t=this.cache,n=e.elements;if(n===void 0){if(yt(t,e))return;i.uniformMatrix3fv(this.addr,!1,e),St(t,e)}else{if(yt(t,n))return;Su.set(n),i.uniformMatrix3fv(this.addr,!1,Su),St(t,n)}}function g0(i,e){let t=this.cache,n=e.elements;if(n===void 0){if(yt(t,e))return;i.uniformMatrix4fv(this.addr,!1,e),St(t,e)}else{if(yt(t,n))return;yu.set(n),i.uniformMatrix4fv(this.addr,!1,yu),St(t,n)}}function v0(i,e){let t=this.cache;t[0]!==e&&(i.uniform1i(this.addr,e),t[0]=e)}function x0(i,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y)&&(i.uniform2i(this.addr,e.x,e.y),t[0]=e.x,t[1]=e.y);else{if(yt(t,e))return;i.uniform2iv(this.addr,e),St(t,e)}}function y0(i,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y||t[2]!==e.z)&&(i.uniform3i(this.addr,e.x,e.y,e.z),t[0]=e.x,t[1]=e.y,t[2]=e.z);else{if(yt(t,e))return;i.uniform3iv(this.addr,e),St(t,e)}}function S0(i,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y||t[2]!==e.z||t[3]!==e.w)&&(i.uniform4i(this.addr,e.x,e.y,e.z,e.w),t[0]=e.x,t[1]=e.y,t[2]=e.z,t[3]=e.w);else{if(yt(t,e))return;i.uniform4iv(this.addr,e),St(t,e)}}function M0(i,e){let t=this.cache;t[0]!==e&&(i.uniform1ui(this.addr,e),t[0]=e)}function b0(i,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y)&&(i.uniform2ui(this.addr,e.x,e.y),t[0]=e.x,t[1]=e.y);else{if(yt(t,e))return;i.uniform2uiv(this.addr,e),St(t,e)}}function _0(i,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y||t[2]!==e.z)&&(i.uniform3ui(this.addr,e.x,e.y,e.z),t[0]=e.x,t[1]=e.y,t[2]=e.z);else{if(yt(t,e))return;i.uniform3uiv(this.addr,e),St(t,e)}}function w0(i,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y||t[2]!==e.z||t[3]!==e.w)&&(i.uniform4ui(this.addr,e.x,e.y,e.z,e.w),t[0]=e.x,t[1]=e.y,t[2]=e.z,t[3]=e.w);else{if(yt(t,e))return;i.uniform4uiv(this.addr,e),St(t,e)}}function va(i){return i.version===0&&(i.compareFunction=Bl,i.needsUpdate=!0),i}function E0(i,e,t){let n=this.cache,s=t.allocateTextureUnit();n[0]!==s&&(i.uniform1i(this.addr,s),n[0]=s);let r;this.type===i.SAMPLER_2D_SHADOW?r=va(ku):r=Bu,t.setTexture2D(e||r,s)}function A0(i,e,t){let n=this.cache,s=t.allocateTextureUnit();n[0]!==s&&(i.uniform1i(this.addr,s),n[0]=s),t.setTexture3D(e||Vu,s)}function T0(i,e,t){let n=this.cache,s=t.allocateTextureUnit();n[0]!==s&&(i.uniform1i(this.addr,s),n[0]=s);let r;this.type===i.SAMPLER_CUBE_SHADOW?r=va(zu):r=Hu,t.setTextureCube(e||r,s)}function R0(i,e,t){let n=this.cache,s=t.allocateTextureUnit();n[0]!==s&&(i.uniform1i(this.addr,s),n[0]=s),t.setTexture2DArray(e||Gu,s)}function C0(i){switch(i){case 5126:return h0;case 35664:return u0;case 35665:return d0;case 35666:return f0;case 35674:return p0;case 35675:return m0;case 35676:return g0;case 5124:case 35670:return v0;case 35667:case 35671:return x0;case 35668:case 35672:return y0;case 35669:case 35673:return S0;case 5125:return M0;case 36294:return b0;case 36295:return _0;case 36296:return w0;case 35678:case 36198:case 36298:case 36306:case 35682:return E0;case 35679:case 36299:case 36307:return A0;case 35680:case 36300:case 36308:case 36293:return T0;case 36289:case 36303:case 36311:case 36292:return R0}}function P0(i,e){i.uniform1fv(this.addr,e)}function L0(i,e){let t=ms(e,this.size,2);i.uniform2fv(this.addr,t)}function I0(i,e){let t=ms(e,this.size,3);i.uniform3fv(this.addr,t)}function N0(i,e){let t=ms(e,this.size,4);i.uniform4fv(this.addr,t)}function D0(i,e){let t=ms(e,this.size,4);i.uniformMatrix2fv(this.addr,!1,t)}function U0(i,e){let t=ms(e,this.size,9);i.uniformMatrix3fv(this.addr,!1,t)}function O0(i,e){let t=ms(e,this.size,16);i.uniformMatrix4fv(this.addr,!1,t)}function F0(i,e){i.uniform1iv(this.addr,e)}function B0(i,e){i.uniform2iv(this.addr,e)}function k0(i,e){i.uniform3iv(this.addr,e)}function z0(i,e){i.uniform4iv(this.addr,e)}function G0(i,e){i.uniform1uiv(this.addr,e)}function V0(i,e){i.uniform2uiv(this.addr,e)}function H0(i,e){i.uniform3uiv(this.addr,e)}function W0(i,e){i.uniform4uiv(this.addr,e)}function X0(i,e,t){let n=this.cache,s=e.length,r=ga(t,s);yt(n,r)||(i.uniform1iv(this.addr,r),St(n,r));let o;this.type===i.SAMPLER_2D_SHADOW?o=va(ku):o=Bu;for(let a=0;a!==s;++a)t.setTexture2D(e[a]||o,r[a])}function q0(i,e,t){let n=this.cache,s=e.length,r=ga(t,s);yt(n,r)||(i.uniform1iv(this.addr,r),St(n,r));for(let o=0;o!==s;++o)t.setTexture3D(e[o]||Vu,r[o])}function Y0(i,e,t){let n=this.cache,s=e.length,r=ga(t,s);yt(n,r)||(i.uniform1iv(this.addr,r),St(n,r));let o;this.type===i.SAMPLER_CUBE_SHADOW?o=va(zu):o=Hu;for(let a=0;a!==s;++a)t.setTextureCube(e[a]||o,r[a])}function $0(i,e,t){let n=this.cache,s=e.length,r=ga(t,s);yt(n,r)||(i.uniform1iv(this.addr,r),St(n,r));for(let o=0;o!==s;++o)t.setTexture2DArray(e[o]||Gu,r[o])}function Z0(i){switch(i){case 5126:return P0;case 35664:return L0;case 35665:return I0;case 35666:return N0;case 35674:return D0;case 35675:return U0;case 35676:return O0;case 5124:case 35670:return F0;case 35667:case 35671:return B0;case 35668:case 35672:return k0;case 35669:case 35673:return z0;case 5125:return G0;case 36294:return V0;case 36295:return H0;case 36296:return W0;case 35678:case 36198:case 36298:case 36306:case 35682:return X0;case 35679:case 36299:case 36307:return q0;case 35680:case 36300:case 36308:case 36293:return Y0;case 36289:case 36303:case 36311:case 36292:return $0}}var jl=class{constructor(e,t,n){this.id=e,this.addr=n,this.cache=[],this.type=t.type,this.setValue=C0(t.type)}},Jl=class{constructor(e,t,n){this.id=e,this.addr=n,this.cache=[],this.type=t.type,this.size=t.size,this.setValue=Z0(t.type)}},Kl=class{constructor(e){this.id=e,this.seq=[],this.map={}}setValue(e,t,n){let s=this.seq;for(let r=0,o=s.length;r!==o;++r){let a=s[r];a.setValue(e,t[a.id],n)}}},$l=/(\w+)(\])?(\[|\.)?/g;function bu(i,e){i.seq.push(e),i.map[e.id]=e}function j0(i,e,t){let n=i.name,s=n.length;for($l.lastIndex=0;;){let r=$l.exec(n),o=$l.lastIndex,a=r[1],l=r[2]==="]",c=r[3];if(l&&(a=a|0),c===void 0||c==="["&&o+2===s){bu(t,c===void 0?new jl(a,i,e):new Jl(a,i,e));break}else{let d=t.map[a];d===void 0&&(d=new Kl(a),bu(t,d)),t=d}}}var ps=class{constructor(e,t){this.seq=[],this.map={};let n=e.getProgramParameter(t,e.ACTIVE_UNIFORMS);for(let o=0;o<n;++o){let a=e.getActiveUniform(t,o),l=e.getUniformLocation(t,a.name);j0(a,l,this)}let s=[],r=[];for(let o of this.seq)o.type===e.SAMPLER_2D_SHADOW||o.type===e.SAMPLER_CUBE_SHADOW||o.type===e.SAMPLER_2D_ARRAY_SHADOW?s.push(o):r.push(o);s.length>0&&(this.seq=s.concat(r))}setValue(e,t,n,s){let r=this.map[t];r!==void 0&&r.setValue(e,n,s)}setOptional(e,t,n){let s=t[n];s!==void 0&&this.setValue(e,n,s)}static upload(e,t,n,s){for(let r=0,o=t.length;r!==o;++r){let a=t[r],l=n[a.id];l.needsUpdate!==!1&&a.setValue(e,l.value,s)}}static seqWithValue(e,t){let n=[];for(let s=0,r=e.length;s!==r;++s){let o=e[s];o.id in t&&n.push(o)}return n}};function _u(i,e,t){let n=i.createShader(e);return i.shaderSource(n,t),i.compileShader(n),n}var J0=37297,K0=0;function Q0(i,e){let t=i.split(`
`),n=[],s=Math.max(e-6,0),r=Math.min(e+6,t.length);for(let o=s;o<r;o++){let a=o+1;n.push(`${a===e?">":" "} ${a}: ${t[o]}`)}return n.join(`
`)}var wu=new Ue;function ev(i){Ye.Oi(wu,Ye.workingColorSpace,i);let e=`mat3( ${wu.elements.map(t=>t.toFixed(4))} )`;switch(Ye.getTransfer(i)){case Is:return[e,"LinearTransferOETF"];case Qe:return[e,"sRGBTransferOETF"];default:return Ce("WebGLProgram: Unsupported color space: ",i),[e,"LinearTransferOETF"]}}function Eu(i,e,t){let n=i.getShaderParameter(e,i.COMPILE_STATUS),r=(i.getShaderInfoLog(e)||"").trim();if(n&&r==="")return"";let o=/ERROR: 0:(\d+)/.exec(r);if(o){let a=parseInt(o[1]);return t.toUpperCase()+`

`+r+`

`+Q0(i.getShaderSource(e),a)}else return r}function tv(i,e){let t=ev(e);return[`vec4 ${i}( vec4 value ) {`,`	return ${t[1]}( vec4( ${t[0]} * value.rgb, value.a ) );`,"}"].join(`
`)}var nv={[Sl]:"Linear",[Ml]:"Reinhard",[bl]:"Cineon",[_l]:"ACESFilmic",[El]:"AgX",[Al]:"Neutral",[wl]:"Custom"};function iv(i,e){let t=nv[e];return t===void 0?(Ce("WebGLProgram: Unsupported toneMapping:",e),"vec3 "+i+"( vec3 color ) { return LinearToneMapping( color ); }"):"vec3 "+i+"( vec3 color ) { return "+t+"ToneMapping( color ); }"}var fa=new N;function sv(){Ye.getLuminanceCoefficients(fa);let i=fa.x.toFixed(4),e=fa.y.toFixed(4),t=fa.z.toFixed(4);return["float luminance( const in vec3 rgb ) {",`	const vec3 weights = vec3( ${i}, ${e}, ${t} );`,"	return dot( weights, rgb );","}"].join(`
`)}function rv(i){return[i.extensionClipCullDistance?"#extension GL_ANGLE_clip_cull_distance : require":"",i.extensionMultiDraw?"#extension GL_ANGLE_multi_draw : require":""].filter(sr).join(`
`)}function ov(i){let e=[];for(let t in i){let n=i[t];n!==!1&&e.push("#define "+t+" "+n)}return e.join(`
`)}function av(i,e){let t={},n=i.getProgramParameter(e,i.ACTIVE_ATTRIBUTES);for(let s=0;s<n;s++){let r=i.getActiveAttrib(e,s),o=r.name,a=1;r.type===i.FLOAT_MAT2&&(a=2),r.type===i.FLOAT_MAT3&&(a=3),r.type===i.FLOAT_MAT4&&(a=4),t[o]={type:r.type,location:i.getAttribLocation(e,o),locationSize:a}}return t}function sr(i){return i!==""}function Au(i,e){let t=e.numSpotLightShadows+e.numSpotLightMaps-e.numSpotLightShadowsWithMaps;return i.replace(/NUM_SUN_LIGHTS/g,e.numSunLights).replace(/NUM_DIR_LIGHTS/g,e.numDirLights).replace(/NUM_SPOT_LIGHTS/g,e.numSpotLights).replace(/NUM_SPOT_LIGHT_MAPS/g,e.numSpotLightMaps).replace(/NUM_SPOT_LIGHT_COORDS/g,t).replace(/NUM_RECT_AREA_LIGHTS/g,e.numRectAreaLights).replace(/NUM_POINT_LIGHTS/g,e.numPointLights).replace(/NUM_HEMI_LIGHTS/g,e.numHemiLights).replace(/NUM_SUN_LIGHT_SHADOWS/g,e.numSunLightShadows).replace(/NUM_DIR_LIGHT_SHADOWS/g,e.numDirLightShadows).replace(/NUM_SPOT_LIGHT_SHADOWS_WITH_MAPS/g,e.numSpotLightShadowsWithMaps).replace(/NUM_SPOT_LIGHT_SHADOWS/g,e.numSpotLightShadows).replace(/NUM_POINT_LIGHT_SHADOWS/g,e.numPointLightShadows).replace(/NUM_LIGHT_PROBE_GRIDS/g,e.numLightProbeGrids)}function Tu(i,e){return i.replace(/NUM_CLIPPING_PLANES/g,e.numClippingPlanes).replace(/UNION_CLIPPING_PLANES/g,e.numClippingPlanes-e.numClipIntersection)}var lv=/^[ \t]*#include +<([\w\d./]+)>/gm;function Ql(i){return i.replace(lv,cv)}function cv(i,e){let t=Ve[e];if(t===void 0)throw new Error("THREE.WebGLProgram: Can not resolve #include <"+e+">");return Ql(t)}var hv=/#pragma unroll_loop_start\s+for\s*\(\s*int\s+i\s*=\s*(\d+)\s*;\s*i\s*<\s*(\d+)\s*;\s*i\s*\+\+\s*\)\s*{([\s\S]+?)}\s+#pragma unroll_loop_end/g;function Ru(i){return i.replace(hv,uv)}function uv(i,e,t,n){let s="";for(let r=parseInt(e);r<parseInt(t);r++)s+=n.replace(/\[\s*i\s*\]/g,"[ "+r+" ]").replace(/UNROLLED_LOOP_INDEX/g,r);return s}function Cu(i){let e=`precision ${i.precision} float;
precision ${i.precision} int;
precision ${i.precision} sampler2D;
precision ${i.precision} samplerCube;
precision ${i.precision} sampler3D;
precision ${i.precision} sampler2DArray;
precision ${i.precision} sampler2DShadow;
precision ${i.precision} samplerCubeShadow;
precision ${i.precision} sampler2DArrayShadow;
precision ${i.precision} isampler2D;
precision ${i.precision} isampler3D;
precision ${i.precision} isamplerCube;
precision ${i.precision} isampler2DArray;
precision ${i.precision} usampler2D;
precision ${i.precision} usampler3D;
precision ${i.precision} usamplerCube;
precision ${i.precision} usampler2DArray;
`;return i.precision==="highp"?e+=`
#define HIGH_PRECISION`:i.precision==="mediump"?e+=`
#define MEDIUM_PRECISION`:i.precision==="lowp"&&(e+=`
#define LOW_PRECISION`),e}var dv={[Zs]:"SHADOWMAP_TYPE_PCF",[cs]:"SHADOWMAP_TYPE_VSM"};function fv(i){return dv[i.shadowMapType]||"SHADOWMAP_TYPE_BASIC"}var pv={[us]:"ENVMAP_MODE_REFRACTION"};function mv(i){return i.envMap===!1?"ENVMAP_MODE_REFLECTION":pv[i.envMapMode]||"ENVMAP_MODE_REFLECTION"}var gv={[yl]:"ENVMAP_BLENDING_MULTIPLY",[Xh]:"ENVMAP_BLENDING_MIX",[qh]:"ENVMAP_BLENDING_ADD"};function vv(i){return i.envMap===!1?"ENVMAP_BLENDING_NONE":gv[i.combine]||"ENVMAP_BLENDING_NONE"}function xv(i,e,t,n){let s=i.getContext(),r=t.defines,o=t.vertexShader,a=t.fragmentShader,l=fv(t),c=t.envMapPMREM===!0?"ENVMAP_TYPE_PMREM":"ENVMAP_TYPE_CUBE",h=mv(t),d=vv(t),u=rv(t),f=ov(r),v=s.createProgram(),S,m,p=t.glslVersion?"#version "+t.glslVersion+`
`:"";t.isRawShaderMaterial?(S=["#define SHADER_TYPE "+t.shaderType,"#define SHADER_NAME "+t.shaderName,f].filter(sr).join(`
`),S.length>0&&(S+=`
`),m=["#define SHADER_TYPE "+t.shaderType,"#define SHADER_NAME "+t.shaderName,f].filter(sr).join(`
`),m.length>0&&(m+=`
`)):(S=[Cu(t),"#define SHADER_TYPE "+t.shaderType,"#define SHADER_NAME "+t.shaderName,f,t.extensionClipCullDistance?"#define USE_CLIP_DISTANCE":"",t.batching?"#define USE_BATCHING":"",t.batchingColor?"#define USE_BATCHING_COLOR":"",t.instancing?"#define USE_INSTANCING":"",t.instancingColor?"#define USE_INSTANCING_COLOR":"",t.instancingMorph?"#define USE_INSTANCING_MORPH":"",t.useFog&&t.fog?"#define USE_FOG":"",t.useFog&&t.fogExp2?"#define FOG_EXP2":"",t.map?"#define USE_MAP":"",t.envMap?"#define USE_ENVMAP":"",t.envMap?"#define "+h:"",t.lightMap?"#define USE_LIGHTMAP":"",t.aoMap?"#define USE_AOMAP":"",t.bumpMap?"#define USE_BUMPMAP":"",t.normalMap?"#define USE_NORMALMAP":"",t.normalMapObjectSpace?"#define USE_NORMALMAP_OBJECTSPACE":"",t.normalMapTangentSpace?"#define USE_NORMALMAP_TANGENTSPACE":"",t.displacementMap?"#define USE_DISPLACEMENTMAP":"",t.emissiveMap?"#define USE_EMISSIVEMAP":"",t.anisotropy?"#define USE_ANISOTROPY":"",t.anisotropyMap?"#define USE_ANISOTROPYMAP":"",t.clearcoatMap?"#define USE_CLEARCOATMAP":"",t.clearcoatRoughnessMap?"#define USE_CLEARCOAT_ROUGHNESSMAP":"",t.clearcoatNormalMap?"#define USE_CLEARCOAT_NORMALMAP":"",t.diffuseRoughnessMap?"#define USE_DIFFUSE_ROUGHNESSMAP":"",t.iridescenceMap?"#define USE_IRIDESCENCEMAP":"",t.iridescenceThicknessMap?"#define USE_IRIDESCENCE_THICKNESSMAP":"",t.specularMap?"#define USE_SPECULARMAP":"",t.specularColorMap?"#define USE_SPECULAR_COLORMAP":"",t.specularIntensityMap?"#define USE_SPECULAR_INTENSITYMAP":"",t.roughnessMap?"#define USE_ROUGHNESSMAP":"",t.metalnessMap?"#define USE_METALNESSMAP":"",t.alphaMap?"#define USE_ALPHAMAP":"",t.alphaHash?"#define USE_ALPHAHASH":"",t.transmission?"#define USE_TRANSMISSION":"",t.transmissionMap?"#define USE_TRANSMISSIONMAP":"",t.thicknessMap?"#define USE_THICKNESSMAP":"",t.sheenColorMap?"#define USE_SHEEN_COLORMAP":"",t.sheenRoughnessMap?"#define USE_SHEEN_ROUGHNESSMAP":"",t.mapUv?"#define MAP_UV "+t.mapUv:"",t.alphaMapUv?"#define ALPHAMAP_UV "+t.alphaMapUv:"",t.lightMapUv?"#define LIGHTMAP_UV "+t.lightMapUv:"",t.aoMapUv?"#define AOMAP_UV "+t.aoMapUv:"",t.emissiveMapUv?"#define EMISSIVEMAP_UV "+t.emissiveMapUv:"",t.bumpMapUv?"#define BUMPMAP_UV "+t.bumpMapUv:"",t.normalMapUv?"#define NORMALMAP_UV "+t.normalMapUv:"",t.displacementMapUv?"#define DISPLACEMENTMAP_UV "+t.displacementMapUv:"",t.metalnessMapUv?"#define METALNESSMAP_UV "+t.metalnessMapUv:"",t.roughnessMapUv?"#define ROUGHNESSMAP_UV "+t.roughnessMapUv:"",t.anisotropyMapUv?"#define ANISOTROPYMAP_UV "+t.anisotropyMapUv:"",t.clearcoatMapUv?"#define CLEARCOATMAP_UV "+t.clearcoatMapUv:"",t.clearcoatNormalMapUv?"#define CLEARCOAT_NORMALMAP_UV "+t.clearcoatNormalMapUv:"",t.clearcoatRoughnessMapUv?"#define CLEARCOAT_ROUGHNESSMAP_UV "+t.clearcoatRoughnessMapUv:"",t.diffuseRoughnessMapUv?"#define DIFFUSE_ROUGHNESSMAP_UV "+t.diffuseRoughnessMapUv:"",t.iridescenceMapUv?"#define IRIDESCENCEMAP_UV "+t.iridescenceMapUv:"",t.iridescenceThicknessMapUv?"#define IRIDESCENCE_THICKNESSMAP_UV "+t.iridescenceThicknessMapUv:"",t.sheenColorMapUv?"#define SHEEN_COLORMAP_UV "+t.sheenColorMapUv:"",t.sheenRoughnessMapUv?"#define SHEEN_ROUGHNESSMAP_UV "+t.sheenRoughnessMapUv:"",t.specularMapUv?"#define SPECULARMAP_UV "+t.specularMapUv:"",t.specularColorMapUv?"#define SPECULAR_COLORMAP_UV "+t.specularColorMapUv:"",t.specularIntensityMapUv?"#define SPECULAR_INTENSITYMAP_UV "+t.specularIntensityMapUv:"",t.transmissionMapUv?"#define TRANSMISSIONMAP_UV "+t.transmissionMapUv:"",t.thicknessMapUv?"#define THICKNESSMAP_UV "+t.thicknessMapUv:"",t.vertexTangents&&t.flatShading===!1?"#define USE_TANGENT":"",t.vertexNormals?"#define HAS_NORMAL":"",t.vertexColors?"#define USE_COLOR":"",t.vertexAlphas?"#define USE_COLOR_ALPHA":"",t.vertexUv1s?"#define USE_UV1":"",t.vertexUv2s?"#define USE_UV2":"",t.vertexUv3s?"#define USE_UV3":"",t.pointsUvs?"#define USE_POINTS_UV":"",t.flatShading?"#define FLAT_SHADED":"",t.skinning?"#define USE_SKINNING":"",t.morphTargets?"#define USE_MORPHTARGETS":"",t.morphNormals&&t.flatShading===!1?"#define USE_MORPHNORMALS":"",t.morphColors?"#define USE_MORPHCOLORS":"",t.morphTargetsCount>0?"#define MORPHTARGETS_TEXTURE_STRIDE "+t.morphTextureStride:"",t.morphTargetsCount>0?"#define MORPHTARGETS_COUNT "+t.morphTargetsCount:"",t.doubleSided?"#define DOUBLE_SIDED":"",t.flipSided?"#define FLIP_SIDED":"",t.shadowMapEnabled?"#define USE_SHADOWMAP":"",t.shadowMapEnabled?"#define "+l:"",t.sizeAttenuation?"#define USE_SIZEATTENUATION":"",t.numLightProbes>0?"#define USE_LIGHT_PROBES":"",t.logarithmicDepthBuffer?"#define USE_LOGARITHMIC_DEPTH_BUFFER":"",t.reversedDepthBuffer?"#define USE_REVERSED_DEPTH_BUFFER":"","uniform mat4 modelMatrix;","uniform mat4 modelViewMatrix;","uniform mat4 projectionMatrix;","uniform mat4 viewMatrix;","uniform mat3 normalMatrix;","uniform vec3 cameraPosition;","uniform bool isOrthographic;","#ifdef USE_INSTANCING","	attribute mat4 instanceMatrix;","#endif","#ifdef USE_INSTANCING_COLOR","	attribute vec3 instanceColor;","#endif","#ifdef USE_INSTANCING_MORPH","	uniform sampler2D morphTexture;","#endif","attribute vec3 position;","attribute vec3 normal;","attribute vec2 uv;","#ifdef USE_UV1","	attribute vec2 uv1;","#endif","#ifdef USE_UV2","	attribute vec2 uv2;","#endif","#ifdef USE_UV3","	attribute vec2 uv3;","#endif","#ifdef USE_TANGENT","	attribute vec4 tangent;","#endif","#if defined( USE_COLOR_ALPHA )","	attribute vec4 color;","#elif defined( USE_COLOR )","	attribute vec3 color;","#endif","#ifdef USE_SKINNING","	attribute vec4 skinIndex;","	attribute vec4 skinWeight;","#endif",`
`].filter(sr).join(`
`),m=[Cu(t),"#define SHADER_TYPE "+t.shaderType,"#define SHADER_NAME "+t.shaderName,f,t.useFog&&t.fog?"#define USE_FOG":"",t.useFog&&t.fogExp2?"#define FOG_EXP2":"",t.alphaToCoverage?"#define ALPHA_TO_COVERAGE":"",t.map?"#define USE_MAP":"",t.matcap?"#define USE_MATCAP":"",t.envMap?"#define USE_ENVMAP":"",t.envMap?"#define "+c:"",t.envMap?"#define "+h:"",t.envMap?"#define "+d:"",t.envMapPMREM?"#define ENVMAP_MAX_LOD "+t.envMapMaxLod+".0":"",t.envMapPMREM?"#define ENVMAP_SIZE "+t.envMapSize+".0":"",t.lightMap?"#define USE_LIGHTMAP":"",t.aoMap?"#define USE_AOMAP":"",t.bumpMap?"#define USE_BUMPMAP":"",t.normalMap?"#define USE_NORMALMAP":"",t.normalMapObjectSpace?"#define USE_NORMALMAP_OBJECTSPACE":"",t.normalMapTangentSpace?"#define USE_NORMALMAP_TANGENTSPACE":"",t.packedNormalMap?"#define USE_PACKED_NORMALMAP":"",t.emissiveMap?"#define USE_EMISSIVEMAP":"",t.anisotropy?"#define USE_ANISOTROPY":"",t.anisotropyMap?"#define USE_ANISOTROPYMAP":"",t.clearcoat?"#define USE_CLEARCOAT":"",t.clearcoatMap?"#define USE_CLEARCOATMAP":"",t.clearcoatRoughnessMap?"#define USE_CLEARCOAT_ROUGHNESSMAP":"",t.clearcoatNormalMap?"#define USE_CLEARCOAT_NORMALMAP":"",t.diffuseRoughness?"#define USE_DIFFUSE_ROUGHNESS":"",t.diffuseRoughnessMap?"#define USE_DIFFUSE_ROUGHNESSMAP":"",t.dispersion?"#define USE_DISPERSION":"",t.retroreflection?"#define USE_RETROREFLECTION":"",t.iridescence?"#define USE_IRIDESCENCE":"",t.iridescenceMap?"#define USE_IRIDESCENCEMAP":"",t.iridescenceThicknessMap?"#define USE_IRIDESCENCE_THICKNESSMAP":"",t.specularMap?"#define USE_SPECULARMAP":"",t.specularColorMap?"#define USE_SPECULAR_COLORMAP":"",t.specularIntensityMap?"#define USE_SPECULAR_INTENSITYMAP":"",t.roughnessMap?"#define USE_ROUGHNESSMAP":"",t.metalnessMap?"#define USE_METALNESSMAP":"",t.alphaMap?"#define USE_ALPHAMAP":"",t.alphaTest?"#define USE_ALPHATEST":"",t.alphaHash?"#define USE_ALPHAHASH":"",t.sheen?"#define USE_SHEEN":"",t.sheenColorMap?"#define USE_SHEEN_COLORMAP":"",t.sheenRoughnessMap?"#define USE_SHEEN_ROUGHNESSMAP":"",t.transmission?"#define USE_TRANSMISSION":"",t.transmissionMap?"#define USE_TRANSMISSIONMAP":"",t.thicknessMap?"#define USE_THICKNESSMAP":"",t.vertexTangents&&t.flatShading===!1?"#define USE_TANGENT":"",t.vertexColors||t.instancingColor?"#define USE_COLOR":"",t.vertexAlphas||t.batchingColor?"#define USE_COLOR_ALPHA":"",t.vertexUv1s?"#define USE_UV1":"",t.vertexUv2s?"#define USE_UV2":"",t.vertexUv3s?"#define USE_UV3":"",t.pointsUvs?"#define USE_POINTS_UV":"",t.gradientMap?"#define USE_GRADIENTMAP":"",t.flatShading?"#define FLAT_SHADED":"",t.doubleSided?"#define DOUBLE_SIDED":"",t.flipSided?"#define FLIP_SIDED":"",t.shadowMapEnabled?"#define USE_SHADOWMAP":"",t.shadowMapEnabled?"#define "+l:"",t.premultipliedAlpha?"#define PREMULTIPLIED_ALPHA":"",t.numLightProbes>0?"#define USE_LIGHT_PROBES":"",t.decodeVideoTexture?"#define DECODE_VIDEO_TEXTURE":"",t.decodeVideoTextureEmissive?"#define DECODE_VIDEO_TEXTURE_EMISSIVE":"",t.logarithmicDepthBuffer?"#define USE_LOGARITHMIC_DEPTH_BUFFER":"",t.reversedDepthBuffer?"#define USE_REVERSED_DEPTH_BUFFER":"","uniform mat4 viewMatrix;","uniform vec3 cameraPosition;","uniform bool isOrthographic;",t.toneMapping!==Cn?"#define TONE_MAPPING":"",t.toneMapping!==Cn?Ve.tonemapping_pars_fragment:"",t.toneMapping!==Cn?iv("toneMapping",t.toneMapping):"",t.dithering?"#define DITHERING":"",t.opaque?"#define OPAQUE":"",Ve.colorspace_pars_fragment,tv("linearToOutputTexel",t.outputColorSpace),sv(),t.useDepthPacking?"#define DEPTH_PACKING "+t.depthPacking:"",`
`].filter(sr).join(`
`)),o=Ql(o),o=Au(o,t),o=Tu(o,t),a=Ql(a),a=Au(a,t),a=Tu(a,t),o=Ru(o),a=Ru(a),t.isRawShaderMaterial!==!0&&(p=`#version 300 es
`,S=[u,"#define attribute in","#define varying out","#define texture2D texture"].join(`
`)+`
`+S,m=["#define varying in",t.glslVersion===Di?"":"layout(location = 0) out highp vec4 pc_fragColor;",t.glslVersion===Di?"":"#define gl_FragColor pc_fragColor","#define gl_FragDepthEXT gl_FragDepth","#define texture2D texture","#define textureCube texture","#define texture2DProj textureProj","#define texture2DLodEXT textureLod","#define texture2DProjLodEXT textureProjLod","#define textureCubeLodEXT textureLod","#define texture2DGradEXT textureGrad","#define texture2DProjGradEXT textureProjGrad","#define textureCubeGradEXT textureGrad"].join(`
`)+`
`+m);let _=p+S+o,R=p+m+a,w=_u(s,s.VERTEX_SHADER,_),T=_u(s,s.FRAGMENT_SHADER,R);s.attachShader(v,w),s.attachShader(v,T),t.index0AttributeName!==void 0?s.bindAttribLocation(v,0,t.index0AttributeName):t.hasPositionAttribute===!0&&s.bindAttribLocation(v,0,"position"),s.linkProgram(v);function E(L){if(i.debug.checkShaderErrors){let D=s.getProgramInfoLog(v)||"",G=s.getShaderInfoLog(w)||"",$=s.getShaderInfoLog(T)||"",P=D.trim(),q=G.trim(),K=$.trim(),V=!0,re=!0;if(s.getProgramParameter(v,s.LINK_STATUS)===!1)if(V=!1,typeof i.debug.onShaderError=="function")i.debug.onShaderError(s,v,w,T);else{let X=Eu(s,w,"vertex"),te=Eu(s,T,"fragment");Ne("WebGLProgram: Shader Error "+s.getError()+" - VALIDATE_STATUS "+s.getProgramParameter(v,s.VALIDATE_STATUS)+`

Material Name: `+L.name+`
Material Type: `+L.type+`

Program Info Log: `+P+`
`+X+`
`+te)}else P!==""?Ce("WebGLProgram: Program Info Log:",P):(q===""||K==="")&&(re=!1);re&&(L.diagnostics={runnable:V,programLog:P,vertexShader:{log:q,prefix:S},fragmentShader:{log:K,prefix:m}})}s.deleteShader(w),s.deleteShader(T),g=new ps(s,v),b=av(s,v)}let g;this.getUniforms=function(){return g===void 0&&E(this),g};let b;this.getAttributes=function(){return b===void 0&&E(this),b};let k=t.rendererExtensionParallelShaderCompile===!1;return this.isReady=function(){return k===!1&&(k=s.getProgramParameter(v,J0)),k},this.destroy=function(){n.releaseStatesOfProgram(this),s.deleteProgram(v),this.program=void 0},this.type=t.shaderType,this.name=t.shaderName,this.id=K0++,this.cacheKey=e,this.usedTimes=1,this.program=v,this.vertexShader=w,this.fragmentShader=T,this}var yv=0,ec=class{constructor(){this.shaderCache=new Map,this.materialCache=new Map}update(e,t,n){let s=this.Ls(e);return s.has(t)===!1&&(s.add(t),t.usedTimes++),s.has(n)===!1&&(s.add(n),n.usedTimes++),this}remove(e){let t=this.materialCache.get(e);for(let n of t)n.usedTimes--,n.usedTimes===0&&this.shaderCache.delete(n.code);return this.materialCache.delete(e),this}getVertexShaderStage(e){return this.ci(e.vertexShader)}getFragmentShaderStage(e){return this.ci(e.fragmentShader)}dispose(){this.shaderCache.clear(),this.materialCache.clear()}Ls(e){let t=this.materialCache,n=t.get(e);return n===void 0&&(n=new Set,t.set(e,n)),n}ci(e){let t=this.shaderCache,n=t.get(e);return n===void 0&&(n=new tc(e),t.set(e,n)),n}},tc=class{constructor(e){this.id=yv++,this.code=e,this.usedTimes=0}};function Sv(i){return i===xi||i===tr||i===nr}function Mv(i,e,t,n,s,r){let o=new Os,a=new ec,l=new Set,c=[],h=new Map,d=n.logarithmicDepthBuffer,u={MeshDepthMaterial:"depth",MeshDistanceMaterial:"distance",MeshNormalMaterial:"normal",MeshBasicMaterial:"basic",MeshLambertMaterial:"lambert",MeshPhongMaterial:"phong",MeshToonMaterial:"toon",MeshStandardMaterial:"physical",MeshPhysicalMaterial:"physical",MeshMatcapMaterial:"matcap",LineBasicMaterial:"basic",LineDashedMaterial:"dashed",PointsMaterial:"points",ShadowMaterial:"shadow",SpriteMaterial:"sprite"};function f(g){return l.add(g),g===0?"uv":`uv${g}`}function v(g,b,k,L,D,G){let $=L.fog,P=D.geometry,q=g.isMeshStandardMaterial||g.isMeshLambertMaterial||g.isMeshPhongMaterial?L.environment:null,K=g.isMeshStandardMaterial||g.isMeshLambertMaterial&&!g.envMap||g.isMeshPhongMaterial&&!g.envMap,V=e.get(g.envMap||q,K),re=u[g.type],X=n.precision;g.precision!==null&&(X=n.getMaxPrecision(g.precision),X!==g.precision&&Ce("WebGLProgram.getParameters:",g.precision,"not supported, using",X,"instead."));let te=P.morphAttributes.position||P.morphAttributes.normal||P.morphAttributes.color,ie=te!==void 0?te.length:0,Ee=0;P.morphAttributes.position!==void 0&&(Ee=1),P.morphAttributes.normal!==void 0&&(Ee=2),P.morphAttributes.color!==void 0&&(Ee=3);let Fe,j,xe,be;if(re){let ge=Ln[re];Fe=ge.vertexShader,j=ge.fragmentShader}else{Fe=g.vertexShader,j=g.fragmentShader;let ge=a.getVertexShaderStage(g),tt=a.getFragmentShaderStage(g);a.update(g,ge,tt),xe=ge.id,be=tt.id}let Pe=i.getRenderTarget(),ye=i.state.buffers.depth.getReversed(),ke=D.isInstancedMesh===!0,pt=D.isBatchedMesh===!0,Ie=!!g.map,et=!!g.matcap,nt=!!V,We=nt&&V.isPMREMTexture===!0,Ct=!!g.aoMap,vt=!!g.lightMap,Xt=!!g.bumpMap&&g.wireframe===!1,ct=!!g.normalMap,_n=!!g.displacementMap,_t=!!g.emissiveMap,rn=!!g.metalnessMap,on=!!g.roughnessMap,an=g.anisotropy>0,I=g.clearcoat>0,ln=g.diffuseRoughness>0,ot=g.dispersion>0,at=g.retroreflectivity>0,me=g.iridescence>0,xt=g.sheen>0,Le=g.transmission>0,Oe=an&&!!g.anisotropyMap,M=I&&!!g.clearcoatMap,x=I&&!!g.clearcoatNormalMap,O=I&&!!g.clearcoatRoughnessMap,se=ln&&!!g.diffuseRoughnessMap,ee=me&&!!g.iridescenceMap,le=me&&!!g.iridescenceThicknessMap,fe=xt&&!!g.sheenColorMap,Y=xt&&!!g.sheenRoughnessMap,Z=!!g.specularMap,he=!!g.specularColorMap,A=!!g.specularIntensityMap,J=Le&&!!g.transmissionMap,H=Le&&!!g.thicknessMap,ue=!!g.gradientMap,ae=!!g.alphaMap,ce=g.alphaTest>0,Te=!!g.alphaHash,Ge=!!g.extensions,oe=Cn;g.toneMapped&&(Pe===null||Pe.isXRRenderTarget===!0)&&(oe=i.toneMapping);let Re=We?V.isCompressedCubeTexture?V.image[0].mipmaps:V.mipmaps:null,ze={shaderID:re,shaderType:g.type,shaderName:g.name,vertexShader:Fe,fragmentShader:j,defines:g.defines,customVertexShaderID:xe,customFragmentShaderID:be,isRawShaderMaterial:g.isRawShaderMaterial===!0,glslVersion:g.glslVersion,precision:X,batching:pt,batchingColor:pt&&D.T!==null,instancing:ke,instancingColor:ke&&D.instanceColor!==null,instancingMorph:ke&&D.morphTexture!==null,outputColorSpace:Pe===null?i.outputColorSpace:Pe.isXRRenderTarget===!0?Pe.texture.colorSpace:Ye.workingColorSpace,alphaToCoverage:!!g.alphaToCoverage,map:Ie,matcap:et,envMap:nt,envMapMode:nt&&V.mapping,envMapPMREM:We,envMapMaxLod:We?Re.length-1:null,envMapSize:We?Re[0].width:null,aoMap:Ct,lightMap:vt,bumpMap:Xt,normalMap:ct,displacementMap:_n,emissiveMap:_t,normalMapObjectSpace:ct&&g.normalMapType===Zh,normalMapTangentSpace:ct&&g.normalMapType===Ul,packedNormalMap:ct&&g.normalMapType===Ul&&Sv(g.normalMap.format),metalnessMap:rn,roughnessMap:on,anisotropy:an,anisotropyMap:Oe,clearcoat:I,clearcoatMap:M,clearcoatNormalMap:x,clearcoatRoughnessMap:O,diffuseRoughness:ln,diffuseRoughnessMap:se,dispersion:ot,retroreflection:at,iridescence:me,iridescenceMap:ee,iridescenceThicknessMap:le,sheen:xt,sheenColorMap:fe,sheenRoughnessMap:Y,specularMap:Z,specularColorMap:he,specularIntensityMap:A,transmission:Le,transmissionMap:J,thicknessMap:H,gradientMap:ue,opaque:g.transparent===!1&&g.blending===hs&&g.alphaToCoverage===!1,alphaMap:ae,alphaTest:ce,alphaHash:Te,combine:g.combine,mapUv:Ie&&f(g.map.channel),aoMapUv:Ct&&f(g.aoMap.channel),lightMapUv:vt&&f(g.lightMap.channel),bumpMapUv:Xt&&f(g.bumpMap.channel),normalMapUv:ct&&f(g.normalMap.channel),displacementMapUv:_n&&f(g.displacementMap.channel),emissiveMapUv:_t&&f(g.emissiveMap.channel),metalnessMapUv:rn&&f(g.metalnessMap.channel),roughnessMapUv:on&&f(g.roughnessMap.channel),anisotropyMapUv:Oe&&f(g.anisotropyMap.channel),clearcoatMapUv:M&&f(g.clearcoatMap.channel),clearcoatNormalMapUv:x&&f(g.clearcoatNormalMap.channel),clearcoatRoughnessMapUv:O&&f(g.clearcoatRoughnessMap.channel),diffuseRoughnessMapUv:se&&f(g.diffuseRoughnessMap.channel),iridescenceMapUv:ee&&f(g.iridescenceMap.channel),iridescenceThicknessMapUv:le&&f(g.iridescenceThicknessMap.channel),sheenColorMapUv:fe&&f(g.sheenColorMap.channel),sheenRoughnessMapUv:Y&&f(g.sheenRoughnessMap.channel),specularMapUv:Z&&f(g.specularMap.channel),specularColorMapUv:he&&f(g.specularColorMap.channel),specularIntensityMapUv:A&&f(g.specularIntensityMap.channel),transmissionMapUv:J&&f(g.transmissionMap.channel),thicknessMapUv:H&&f(g.thicknessMap.channel),alphaMapUv:ae&&f(g.alphaMap.channel),vertexTangents:!!P.attributes.tangent&&(ct||an),vertexNormals:!!P.attributes.normal,vertexColors:g.vertexColors,vertexAlphas:g.vertexColors===!0&&!!P.attributes.color&&P.attributes.color.itemSize===4,pointsUvs:D.isPoints===!0&&!!P.attributes.uv&&(Ie||ae),fog:!!$,useFog:g.fog===!0,fogExp2:!!$&&$.isFogExp2,flatShading:g.wireframe===!1&&(g.flatShading===!0||P.attributes.normal===void 0&&ct===!1&&(g.isMeshLambertMaterial||g.isMeshPhongMaterial||g.isMeshStandardMaterial||g.isMeshPhysicalMaterial)),sizeAttenuation:g.sizeAttenuation===!0,logarithmicDepthBuffer:d,reversedDepthBuffer:ye,skinning:D.isSkinnedMesh===!0,hasPositionAttribute:P.attributes.position!==void 0,morphTargets:P.morphAttributes.position!==void 0,morphNormals:P.morphAttributes.normal!==void 0,morphColors:P.morphAttributes.color!==void 0,morphTargetsCount:ie,morphTextureStride:Ee,numSunLights:b.sun.length,numDirLights:b.directional.length,numPointLights:b.point.length,numSpotLights:b.spot.length,numSpotLightMaps:b.spotLightMap.length,numRectAreaLights:b.rectArea.length,numHemiLights:b.hemi.length,numSunLightShadows:b.sunShadowMap.length,numDirLightShadows:b.directionalShadowMap.length,numPointLightShadows:b.pointShadowMap.length,numSpotLightShadows:b.spotShadowMap.length,numSpotLightShadowsWithMaps:b.numSpotLightShadowsWithMaps,numLightProbes:b.numLightProbes,numLightProbeGrids:G.filter(ge=>ge.texture!==null).length,numClippingPlanes:r.numPlanes,numClipIntersection:r.numIntersection,dithering:g.dithering,shadowMapEnabled:i.shadowMap.enabled&&k.length>0,shadowMapType:i.shadowMap.type,toneMapping:oe,decodeVideoTexture:Ie&&g.map.isVideoTexture===!0&&Ye.getTransfer(g.map.colorSpace)===Qe,decodeVideoTextureEmissive:_t&&g.emissiveMap.isVideoTexture===!0&&Ye.getTransfer(g.emissiveMap.colorSpace)===Qe,premultipliedAlpha:g.premultipliedAlpha,doubleSided:g.side===Wt,flipSided:g.side===Nt,useDepthPacking:g.depthPacking>=0,depthPacking:g.depthPacking||0,index0AttributeName:g.index0AttributeName,extensionClipCullDistance:Ge&&g.extensions.clipCullDistance===!0&&t.has("WEBGL_clip_cull_distance"),extensionMultiDraw:(Ge&&g.extensions.multiDraw===!0||pt)&&t.has("WEBGL_multi_draw"),rendererExtensionParallelShaderCompile:t.has("KHR_parallel_shader_compile"),customProgramCacheKey:g.customProgramCacheKey()};return ze.vertexUv1s=l.has(1),ze.vertexUv2s=l.has(2),ze.vertexUv3s=l.has(3),l.clear(),ze}function S(g){let b=[];if(g.shaderID?b.push(g.shaderID):(b.push(g.customVertexShaderID),b.push(g.customFragmentShaderID)),g.defines!==void 0)for(let k in g.defines)b.push(k),b.push(g.defines[k]);return g.isRawShaderMaterial===!1&&(m(b,g),p(b,g),b.push(i.outputColorSpace)),b.push(g.customProgramCacheKey),b.join()}function m(g,b){g.push(b.precision),g.push(b.outputColorSpace),g.push(b.envMapMode),g.push(b.envMapPMREM),g.push(b.envMapMaxLod),g.push(b.envMapSize),g.push(b.mapUv),g.push(b.alphaMapUv),g.push(b.lightMapUv),g.push(b.aoMapUv),g.push(b.bumpMapUv),g.push(b.normalMapUv),g.push(b.displacementMapUv),g.push(b.emissiveMapUv),g.push(b.metalnessMapUv),g.push(b.roughnessMapUv),g.push(b.anisotropyMapUv),g.push(b.clearcoatMapUv),g.push(b.clearcoatNormalMapUv),g.push(b.clearcoatRoughnessMapUv),g.push(b.diffuseRoughnessMapUv),g.push(b.iridescenceMapUv),g.push(b.iridescenceThicknessMapUv),g.push(b.sheenColorMapUv),g.push(b.sheenRoughnessMapUv),g.push(b.specularMapUv),g.push(b.specularColorMapUv),g.push(b.specularIntensityMapUv),g.push(b.transmissionMapUv),g.push(b.thicknessMapUv),g.push(b.combine),g.push(b.fogExp2),g.push(b.sizeAttenuation),g.push(b.morphTargetsCount),g.push(b.numSunLights),g.push(b.numDirLights),g.push(b.numPointLights),g.push(b.numSpotLights),g.push(b.numSpotLightMaps),g.push(b.numHemiLights),g.push(b.numRectAreaLights),g.push(b.numSunLightShadows),g.push(b.numDirLightShadows),g.push(b.numPointLightShadows),g.push(b.numSpotLightShadows),g.push(b.numSpotLightShadowsWithMaps),g.push(b.numLightProbes),g.push(b.numLightProbeGrids),g.push(b.shadowMapType),g.push(b.toneMapping),g.push(b.numClippingPlanes),g.push(b.numClipIntersection),g.push(b.depthPacking)}function p(g,b){o.disableAll(),b.instancing&&o.enable(0),b.instancingColor&&o.enable(1),b.instancingMorph&&o.enable(2),b.matcap&&o.enable(3),b.envMap&&o.enable(4),b.normalMapObjectSpace&&o.enable(5),b.normalMapTangentSpace&&o.enable(6),b.clearcoat&&o.enable(7),b.iridescence&&o.enable(8),b.alphaTest&&o.enable(9),b.vertexColors&&o.enable(10),b.vertexAlphas&&o.enable(11),b.vertexUv1s&&o.enable(12),b.vertexUv2s&&o.enable(13),b.vertexUv3s&&o.enable(14),b.vertexTangents&&o.enable(15),b.anisotropy&&o.enable(16),b.alphaHash&&o.enable(17),b.batching&&o.enable(18),b.dispersion&&o.enable(19),b.retroreflection&&o.enable(24),b.diffuseRoughness&&o.enable(25),b.batchingColor&&o.enable(20),b.gradientMap&&o.enable(21),b.packedNormalMap&&o.enable(22),b.vertexNormals&&o.enable(23),g.push(o.mask),o.disableAll(),b.fog&&o.enable(0),b.useFog&&o.enable(1),b.flatShading&&o.enable(2),b.logarithmicDepthBuffer&&o.enable(3),b.reversedDepthBuffer&&o.enable(4),b.skinning&&o.enable(5),b.morphTargets&&o.enable(6),b.morphNormals&&o.enable(7),b.morphColors&&o.enable(8),b.premultipliedAlpha&&o.enable(9),b.shadowMapEnabled&&o.enable(10),b.doubleSided&&o.enable(11),b.flipSided&&o.enable(12),b.useDepthPacking&&o.enable(13),b.dithering&&o.enable(14),b.transmission&&o.enable(15),b.sheen&&o.enable(16),b.opaque&&o.enable(17),b.pointsUvs&&o.enable(18),b.decodeVideoTexture&&o.enable(19),b.decodeVideoTextureEmissive&&o.enable(20),b.alphaToCoverage&&o.enable(21),b.numLightProbeGrids>0&&o.enable(22),b.hasPositionAttribute&&o.enable(23),g.push(o.mask)}function _(g){let b=u[g.type],k;if(b){let L=Ln[b];k=hu.clone(L.uniforms)}else k=g.uniforms;return k}function R(g,b){let k=h.get(b);return k!==void 0?++k.usedTimes:(k=new xv(i,b,g,s),c.push(k),h.set(b,k)),k}function w(g){if(--g.usedTimes===0){let b=c.indexOf(g);c[b]=c[c.length-1],c.pop(),h.delete(g.cacheKey),g.destroy()}}function T(g){a.remove(g)}function E(){a.dispose()}return{getParameters:v,getProgramCacheKey:S,getUniforms:_,acquireProgram:R,releaseProgram:w,releaseShaderCache:T,programs:c,dispose:E}}function bv(){let i=new WeakMap;function e(o){return i.has(o)}function t(o){let a=i.get(o);return a===void 0&&(a={},i.set(o,a)),a}function n(o){i.delete(o)}function s(o,a,l){i.get(o)[a]=l}function r(){i=new WeakMap}return{has:e,get:t,remove:n,update:s,dispose:r}}function _v(i,e){return i.groupOrder!==e.groupOrder?i.groupOrder-e.groupOrder:i.renderOrder!==e.renderOrder?i.renderOrder-e.renderOrder:i.material.id!==e.material.id?i.material.id-e.material.id:i.materialVariant!==e.materialVariant?i.materialVariant-e.materialVariant:i.z!==e.z?i.z-e.z:i.id-e.id}function Pu(i,e){return i.groupOrder!==e.groupOrder?i.groupOrder-e.groupOrder:i.renderOrder!==e.renderOrder?i.renderOrder-e.renderOrder:i.z!==e.z?e.z-i.z:i.id-e.id}function Lu(){let i=[],e=0,t=[],n=[],s=[];function r(){e=0,t.length=0,n.length=0,s.length=0}function o(u){let f=0;return u.isInstancedMesh&&(f+=2),u.isSkinnedMesh&&(f+=1),f}function a(u,f,v,S,m,p){let _=i[e];return _===void 0?(_={id:u.id,object:u,geometry:f,material:v,materialVariant:o(u),groupOrder:S,renderOrder:u.renderOrder,z:m,group:p},i[e]=_):(_.id=u.id,_.object=u,_.geometry=f,_.material=v,_.materialVariant=o(u),_.groupOrder=S,_.renderOrder=u.renderOrder,_.z=m,_.group=p),e++,_}function l(u,f,v,S,m,p,_){_.reversedDepth===!0&&(m=-m);let R=a(u,f,v,S,m,p);v.transmission>0?n.push(R):v.transparent===!0?s.push(R):t.push(R)}function c(u,f,v,S,m,p){let _=a(u,f,v,S,m,p);v.transmission>0?n.unshift(_):v.transparent===!0?s.unshift(_):t.unshift(_)}function h(u,f){t.length>1&&t.sort(u||_v),n.length>1&&n.sort(f||Pu),s.length>1&&s.sort(f||Pu)}function d(){for(let u=e,f=i.length;u<f;u++){let v=i[u];if(v.id===null)break;v.id=null,v.object=null,v.geometry=null,v.material=null,v.group=null}}return{opaque:t,transmissive:n,transparent:s,init:r,push:l,unshift:c,finish:d,sort:h}}function wv(){let i=new WeakMap;function e(n,s){let r=i.get(n),o;return r===void 0?(o=new Lu,i.set(n,[o])):s>=r.length?(o=new Lu,r.push(o)):o=r[s],o}function t(){i=new WeakMap}return{get:e,dispose:t}}function Ev(){let i={};return{get:function(e){if(i[e.id]!==void 0)return i[e.id];let t;switch(e.type){case"SunLight":case"DirectionalLight":t={direction:new N,color:new Ze};break;case"SpotLight":t={position:new N,direction:new N,color:new Ze,distance:0,coneCos:0,penumbraCos:0,decay:0};break;case"PointLight":t={position:new N,color:new Ze,distance:0,decay:0};break;case"HemisphereLight":t={direction:new N,skyColor:new Ze,groundColor:new Ze};break;case"RectAreaLight":t={color:new Ze,position:new N,halfWidth:new N,halfHeight:new N};break}return i[e.id]=t,t}}}function Av(){let i={};return{get:function(e){if(i[e.id]!==void 0)return i[e.id];let t;switch(e.type){case"SunLight":case"DirectionalLight":t={shadowIntensity:1,shadowBias:0,shadowNormalBias:0,shadowRadius:1,shadowMapSize:new De};break;case"SpotLight":t={shadowIntensity:1,shadowBias:0,shadowNormalBias:0,shadowRadius:1,shadowMapSize:new De};break;case"PointLight":t={shadowIntensity:1,shadowBias:0,shadowNormalBias:0,shadowRadius:1,shadowMapSize:new De,shadowCameraNear:1,shadowCameraFar:1e3};break}return i[e.id]=t,t}}}var Tv=0;function Rv(i,e){return(e.castShadow?2:0)-(i.castShadow?2:0)+(e.map?1:0)-(i.map?1:0)}function Cv(i){let e=new Ev,t=Av(),n={version:0,hash:{sunLength:-1,directionalLength:-1,pointLength:-1,spotLength:-1,rectAreaLength:-1,hemiLength:-1,numSunShadows:-1,numDirectionalShadows:-1,numPointShadows:-1,numSpotShadows:-1,numSpotMaps:-1,numLightProbes:-1},ambient:[0,0,0],probe:[],sun:[],sunShadow:[],sunShadowMap:[],sunShadowMatrix:[],sunShadowCascade:[],directional:[],directionalShadow:[],directionalShadowMap:[],directionalShadowMatrix:[],spot:[],spotLightMap:[],spotShadow:[],spotShadowMap:[],spotLightMatrix:[],rectArea:[],rectAreaLTC1:null,rectAreaLTC2:null,point:[],pointShadow:[],pointShadowMap:[],pointShadowMatrix:[],hemi:[],numSpotLightShadowsWithMaps:0,numLightProbes:0};for(let c=0;c<9;c++)n.probe.push(new N);let s=new N,r=new lt,o=new lt;function a(c){let h=0,d=0,u=0;for(let G=0;G<9;G++)n.probe[G].set(0,0,0);let f=0,v=0,S=0,m=0,p=0,_=0,R=0,w=0,T=0,E=0,g=0,b=0,k=0,L=0;c.sort(Rv);for(let G=0,$=c.length;G<$;G++){let P=c[G],q=P.color,K=P.intensity,V=P.distance,re=null;if(P.shadow&&P.shadow.map&&(P.shadow.map.texture.format===xi?re=P.shadow.map.texture:re=P.shadow.map.depthTexture||P.shadow.map.texture),P.isAmbientLight)h+=q.r*K,d+=q.g*K,u+=q.b*K;else if(P.isLightProbe){for(let X=0;X<9;X++)n.probe[X].addScaledVector(P.sh.coefficients[X],K);L++}else if(P.isSunLight){let X=e.get(P);if(X.color.copy(P.color).multiplyScalar(P.intensity),P.castShadow){let te=P.shadow,ie=t.get(P);ie.shadowIntensity=te.intensity,ie.shadowBias=te.bias,ie.shadowNormalBias=te.normalBias,ie.shadowRadius=te.radius,ie.shadowMapSize.copy(te.mapSize).multiply(te.getFrameExtents()),n.sunShadow[v]=ie,n.sunShadowMap[v]=re;let Ee=te.getViewportCount();for(let Fe=0;Fe<Ee;Fe++)n.sunShadowMatrix[S+Fe]=te.getMatrix(Fe),n.sunShadowCascade[S+Fe]=te.ar[Fe];S+=Ee,v++}n.sun[f]=X,f++}else if(P.isDirectionalLight){let X=e.get(P);if(X.color.copy(P.color).multiplyScalar(P.intensity),P.castShadow){let te=P.shadow,ie=t.get(P);ie.shadowIntensity=te.intensity,ie.shadowBias=te.bias,ie.shadowNormalBias=te.normalBias,ie.shadowRadius=te.radius,ie.shadowMapSize=te.mapSize,n.directionalShadow[m]=ie,n.directionalShadowMap[m]=re,n.directionalShadowMatrix[m]=P.shadow.matrix,T++}n.directional[m]=X,m++}else if(P.isSpotLight){let X=e.get(P);X.position.setFromMatrixPosition(P.matrixWorld),X.color.copy(q).multiplyScalar(K),X.distance=V,X.coneCos=Math.cos(P.angle),X.penumbraCos=Math.cos(P.angle*(1-P.penumbra)),X.decay=P.decay,n.spot[_]=X;let te=P.shadow;if(P.map&&(n.spotLightMap[b]=P.map,b++,te.updateMatrices(P),P.castShadow&&k++),n.spotLightMatrix[_]=te.matrix,P.castShadow){let ie=t.get(P);ie.shadowIntensity=te.intensity,ie.shadowBias=te.bias,ie.shadowNormalBias=te.normalBias,ie.shadowRadius=te.radius,ie.shadowMapSize=te.mapSize,n.spotShadow[_]=ie,n.spotShadowMap[_]=re,g++}_++}else if(P.isRectAreaLight){let X=e.get(P);X.color.copy(q).multiplyScalar(K),X.halfWidth.set(P.width*.5,0,0),X.halfHeight.set(0,P.height*.5,0),n.rectArea[R]=X,R++}else if(P.isPointLight){let X=e.get(P);if(X.color.copy(P.color).multiplyScalar(P.intensity),X.distance=P.distance,X.decay=P.decay,P.castShadow){let te=P.shadow,ie=t.get(P);ie.shadowIntensity=te.intensity,ie.shadowBias=te.bias,ie.shadowNormalBias=te.normalBias,ie.shadowRadius=te.radius,ie.shadowMapSize=te.mapSize,ie.shadowCameraNear=te.camera.near,ie.shadowCameraFar=te.camera.far,n.pointShadow[p]=ie,n.pointShadowMap[p]=re,n.pointShadowMatrix[p]=P.shadow.matrix,E++}n.point[p]=X,p++}else if(P.isHemisphereLight){let X=e.get(P);X.skyColor.copy(P.color).multiplyScalar(K),X.groundColor.copy(P.groundColor).multiplyScalar(K),n.hemi[w]=X,w++}}R>0&&(i.has("OES_texture_float_linear")===!0?(n.rectAreaLTC1=ve.LTC_FLOAT_1,n.rectAreaLTC2=ve.LTC_FLOAT_2):(n.rectAreaLTC1=ve.LTC_HALF_1,n.rectAreaLTC2=ve.LTC_HALF_2)),n.ambient[0]=h,n.ambient[1]=d,n.ambient[2]=u;let D=n.hash;(D.sunLength!==f||D.directionalLength!==m||D.pointLength!==p||D.spotLength!==_||D.rectAreaLength!==R||D.hemiLength!==w||D.numSunShadows!==v||D.numDirectionalShadows!==T||D.numPointShadows!==E||D.numSpotShadows!==g||D.numSpotMaps!==b||D.numLightProbes!==L)&&(n.sun.length=f,n.directional.length=m,n.spot.length=_,n.rectArea.length=R,n.point.length=p,n.hemi.length=w,n.sunShadow.length=v,n.sunShadowMap.length=v,n.sunShadowMatrix.length=S,n.sunShadowCascade.length=S,n.directionalShadow.length=T,n.directionalShadowMap.length=T,n.directionalShadowMatrix.length=T,n.pointShadow.length=E,n.pointShadowMap.length=E,n.pointShadowMatrix.length=E,n.spotShadow.length=g,n.spotShadowMap.length=g,n.spotLightMatrix.length=g+b-k,n.spotLightMap.length=b,n.numSpotLightShadowsWithMaps=k,n.numLightProbes=L,D.sunLength=f,D.directionalLength=m,D.pointLength=p,D.spotLength=_,D.rectAreaLength=R,D.hemiLength=w,D.numSunShadows=v,D.numDirectionalShadows=T,D.numPointShadows=E,D.numSpotShadows=g,D.numSpotMaps=b,D.numLightProbes=L,n.version=Tv++)}function l(c,h){let d=0,u=0,f=0,v=0,S=0,m=0,p=h.matrixWorldInverse;for(let _=0,R=c.length;_<R;_++){let w=c[_];if(w.isSunLight){let T=n.sun[d];T.direction.setFromMatrixPosition(w.matrixWorld),T.direction.transformDirection(p),d++}else if(w.isDirectionalLight){let T=n.directional[u];T.direction.setFromMatrixPosition(w.matrixWorld),s.setFromMatrixPosition(w.target.matrixWorld),T.direction.sub(s),T.direction.transformDirection(p),u++}else if(w.isSpotLight){let T=n.spot[v];T.position.setFromMatrixPosition(w.matrixWorld),T.position.applyMatrix4(p),T.direction.setFromMatrixPosition(w.matrixWorld),s.setFromMatrixPosition(w.target.matrixWorld),T.direction.sub(s),T.direction.transformDirection(p),v++}else if(w.isRectAreaLight){let T=n.rectArea[S];T.position.setFromMatrixPosition(w.matrixWorld),T.position.applyMatrix4(p),o.identity(),r.copy(w.matrixWorld),r.premultiply(p),o.extractRotation(r),T.halfWidth.set(w.width*.5,0,0),T.halfHeight.set(0,w.height*.5,0),T.halfWidth.applyMatrix4(o),T.halfHeight.applyMatrix4(o),S++}else if(w.isPointLight){let T=n.point[f];T.position.setFromMatrixPosition(w.matrixWorld),T.position.applyMatrix4(p),f++}else if(w.isHemisphereLight){let T=n.hemi[m];T.direction.setFromMatrixPosition(w.matrixWorld),T.direction.transformDirection(p),m++}}}return{setup:a,setupView:l,state:n}}function Iu(i){let e=new Cv(i),t=[],n=[],s=[];function r(d){h.camera=d,t.length=0,n.length=0,s.length=0}function o(d){d.isLightProbeGrid?s.push(d):t.push(d)}function a(d){n.push(d)}function l(){e.setup(t),s.sort((d,u)=>d.priority-u.priority||d.id-u.id)}function c(d){e.setupView(t,d)}let h={lightsArray:t,shadowsArray:n,lightProbeGridArray:s,camera:null,lights:e,transmissionRenderTarget:{},textureUnits:0};return{init:r,state:h,setupLights:l,setupLightsView:c,pushLight:o,pushShadow:a}}function Pv(i){let e=new WeakMap;function t(s,r=0){let o=e.get(s),a;return o===void 0?(a=new Iu(i),e.set(s,[a])):r>=o.length?(a=new Iu(i),o.push(a)):a=o[r],a}function n(){e=new WeakMap}return{get:t,dispose:n}}var Lv=`void main() {
gl_Position = vec4( position, 1.0 );
}`,Iv=`uniform sampler2D shadow_pass;
uniform vec2 resolution;
uniform float radius;
void main() {
const float samples = float( VSM_SAMPLES );
float mean = 0.0;
float squared_mean = 0.0;
float uvStride = samples <= 1.0 ? 0.0 : 2.0 / ( samples - 1.0 );
float uvStart = samples <= 1.0 ? 0.0 : - 1.0;
for ( float i = 0.0; i < samples; i ++ ) {
float uvOffset = uvStart + i * uvStride;
#ifdef HORIZONTAL_PASS
vec2 distribution = texture2D( shadow_pass, ( gl_FragCoord.xy + vec2( uvOffset, 0.0 ) * radius ) / resolution ).rg;
mean += distribution.x;
squared_mean += distribution.y * distribution.y + distribution.x * distribution.x;
#else
float depth = texture2D( shadow_pass, ( gl_FragCoord.xy + vec2( 0.0, uvOffset ) * radius ) / resolution ).r;
mean += depth;
squared_mean += depth * depth;
#endif
}
mean = mean / samples;
squared_mean = squared_mean / samples;
float std_dev = sqrt( max( 0.0, squared_mean - mean * mean ) );
gl_FragColor = vec4( mean, std_dev, 0.0, 1.0 );
}`,Nv=[new N(1,0,0),new N(-1,0,0),new N(0,1,0),new N(0,-1,0),new N(0,0,1),new N(0,0,-1)],Dv=[new N(0,-1,0),new N(0,-1,0),new N(0,0,1),new N(0,0,-1),new N(0,-1,0),new N(0,-1,0)],Nu=new lt,ir=new N,Zl=new N;function Uv(i,e,t){let n=new Wn,s=new De,r=new De,o=new dt,a=new fo,l=new po,c={},h=t.maxTextureSize,d={[Rn]:Nt,[Nt]:Rn,[Wt]:Wt},u=new Tn({defines:{VSM_SAMPLES:8},uniforms:{shadow_pass:{value:null},resolution:{value:new De},radius:{value:4}},vertexShader:Lv,fragmentShader:Iv}),f=u.clone();f.defines.HORIZONTAL_PASS=1;let v=new It;v.setAttribute("position",new ut(new Float32Array([-1,-1,.5,3,-1,.5,-1,3,.5]),3));let S=new Ht(v,u),m=this;this.enabled=!1,this.autoUpdate=!0,this.needsUpdate=!1,this.type=Zs;let p=this.type;this.render=function(E,g,b){if(m.enabled===!1||m.autoUpdate===!1&&m.needsUpdate===!1||E.length===0)return;this.type===Ah&&(Ce("WebGLShadowMap: PCFSoftShadowMap has been removed. Using PCFShadowMap instead."),this.type=Zs);let k=i.getRenderTarget(),L=i.getActiveCubeFace(),D=i.getActiveMipmapLevel(),G=i.state;G.setBlending(Pi),G.buffers.depth.getReversed()===!0?G.buffers.color.setClear(0,0,0,0):G.buffers.color.setClear(1,1,1,1),G.buffers.depth.setTest(!0),G.setScissorTest(!1);let $=p!==this.type;$&&g.traverse(function(P){P.material&&(Array.isArray(P.material)?P.material.forEach(q=>q.needsUpdate=!0):P.material.needsUpdate=!0)});for(let P=0,q=E.length;P<q;P++){let K=E[P],V=K.shadow;if(V===void 0){Ce("WebGLShadowMap:",K,"has no shadow.");continue}if(V.autoUpdate===!1&&V.needsUpdate===!1)continue;s.copy(V.mapSize);let re=V.getFrameExtents();s.multiply(re),r.copy(V.mapSize),(s.x>h||s.y>h)&&(s.x>h&&(r.x=Math.floor(h/re.x),s.x=r.x*re.x,V.mapSize.x=r.x),s.y>h&&(r.y=Math.floor(h/re.y),s.y=r.y*re.y,V.mapSize.y=r.y));let X=i.state.buffers.depth.getReversed();if(V.camera.Zt=X,V.map===null||$===!0){if(V.map!==null&&(V.map.depthTexture!==null&&(V.map.depthTexture.dispose(),V.map.depthTexture=null),V.map.dispose()),this.type===cs){if(K.isPointLight){Ce("WebGLShadowMap: VSM shadow maps are not supported for PointLights. Use PCF or BasicShadowMap instead.");continue}V.map=new tn(s.x,s.y,{format:xi,type:Mn,minFilter:Vt,magFilter:Vt,generateMipmaps:!1}),V.map.texture.name=K.name+".shadowMap",V.map.depthTexture=new Xn(s.x,s.y,Sn),V.map.depthTexture.name=K.name+".shadowMapDepth",V.map.depthTexture.format=Vn,V.map.depthTexture.compareFunction=null,V.map.depthTexture.minFilter=Tt,V.map.depthTexture.magFilter=Tt}else K.isPointLight?(V.map=new rr(s.x),V.map.depthTexture=new Hs(s.x,yn)):(V.map=new tn(s.x,s.y),V.map.depthTexture=new Xn(s.x,s.y,yn)),V.map.depthTexture.name=K.name+".shadowMap",V.map.depthTexture.format=Vn,this.type===Zs?(V.map.depthTexture.compareFunction=X?Fl:Ol,V.map.depthTexture.minFilter=Vt,V.map.depthTexture.magFilter=Vt):(V.map.depthTexture.compareFunction=null,V.map.depthTexture.minFilter=Tt,V.map.depthTexture.magFilter=Tt);V.camera.updateProjectionMatrix()}V.map.isWebGLCubeRenderTarget!==!0&&(V.map.width!==s.x||V.map.height!==s.y)&&V.map.setSize(s.x,s.y);let te=V.map.isWebGLCubeRenderTarget?6:V.getViewportCount();K.isPointLight!==!0&&V.updateMatrices(K,b);let ie=(V.camera.layers.mask&4294967294)!==0?V.camera.layers:b.layers;for(let Ee=0;Ee<te;Ee++){let Fe=V.getCamera(Ee);if(K.isPointLight){let j=V.camera,xe=V.matrix,be=K.distance||j.far;be!==j.far&&(j.far=be,j.updateProjectionMatrix()),ir.setFromMatrixPosition(K.matrixWorld),j.position.copy(ir),Zl.copy(j.position),Zl.add(Nv[Ee]),j.up.copy(Dv[Ee]),j.lookAt(Zl),j.updateMatrixWorld(),xe.makeTranslation(-ir.x,-ir.y,-ir.z),Nu.multiplyMatrices(j.projectionMatrix,j.matrixWorldInverse),V.$t.setFromProjectionMatrix(Nu,j.coordinateSystem,j.reversedDepth)}if(V.map.isWebGLCubeRenderTarget)i.setRenderTarget(V.map,Ee),i.clear();else{Ee===0&&(i.setRenderTarget(V.map),i.clear());let j=V.getViewport(Ee);o.set(r.x*j.x,r.y*j.y,r.x*j.z,r.y*j.w),G.viewport(o)}n=V.getFrustum(Ee),w(g,b,Fe,K,ie,this.type)}V.isPointLightShadow!==!0&&this.type===cs&&_(V,b),V.needsUpdate=!1}p=this.type,m.needsUpdate=!1,i.setRenderTarget(k,L,D)};function _(E,g){let b=e.update(S);u.defines.VSM_SAMPLES!==E.blurSamples&&(u.defines.VSM_SAMPLES=E.blurSamples,f.defines.VSM_SAMPLES=E.blurSamples,u.needsUpdate=!0,f.needsUpdate=!0),E.mapPass===null?E.mapPass=new tn(s.x,s.y,{format:xi,type:Mn}):(E.mapPass.width!==E.map.width||E.mapPass.height!==E.map.height)&&E.mapPass.setSize(E.map.width,E.map.height),u.uniforms.shadow_pass.value=E.map.depthTexture,u.uniforms.resolution.value.set(E.map.width,E.map.height),u.uniforms.radius.value=E.radius,i.setRenderTarget(E.mapPass),i.clear(),i.renderBufferDirect(g,null,b,u,S,null),f.uniforms.shadow_pass.value=E.mapPass.texture,f.uniforms.resolution.value.set(E.map.width,E.map.height),f.uniforms.radius.value=E.radius,i.setRenderTarget(E.map),i.clear(),i.renderBufferDirect(g,null,b,f,S,null)}function R(E,g,b,k){let L=null,D=b.isPointLight===!0?E.customDistanceMaterial:E.customDepthMaterial;if(D!==void 0)L=D;else if(L=b.isPointLight===!0?l:a,i.localClippingEnabled&&g.clipShadows===!0&&Array.isArray(g.clippingPlanes)&&g.clippingPlanes.length!==0||g.displacementMap&&g.displacementScale!==0||g.alphaMap&&g.alphaTest>0||g.map&&g.alphaTest>0||g.alphaToCoverage===!0){let G=L.uuid,$=g.uuid,P=c[G];P===void 0&&(P={},c[G]=P);let q=P[$];q===void 0&&(q=L.clone(),P[$]=q,g.addEventListener("dispose",T)),L=q}if(L.visible=g.visible,L.wireframe=g.wireframe,k===cs?L.side=g.shadowSide!==null?g.shadowSide:g.side:L.side=g.shadowSide!==null?g.shadowSide:d[g.side],L.alphaMap=g.alphaMap,L.alphaTest=g.alphaToCoverage===!0?.5:g.alphaTest,L.map=g.map,L.clipShadows=g.clipShadows,L.clippingPlanes=g.clippingPlanes,L.clipIntersection=g.clipIntersection,L.displacementMap=g.displacementMap,L.displacementScale=g.displacementScale,L.displacementBias=g.displacementBias,L.wireframeLinewidth=g.wireframeLinewidth,L.linewidth=g.linewidth,b.isPointLight===!0&&L.isMeshDistanceMaterial===!0){let G=i.properties.get(L);G.light=b}return L}function w(E,g,b,k,L,D){if(E.visible===!1)return;if(E.layers.test(L)&&(E.isMesh||E.isLine||E.isPoints)&&(E.castShadow||E.receiveShadow&&D===cs)&&(!E.frustumCulled||E.intersectsFrustum(n))){E.modelViewMatrix.multiplyMatrices(b.matrixWorldInverse,E.matrixWorld);let P=e.update(E),q=E.material;if(Array.isArray(q)){let K=P.groups;for(let V=0,re=K.length;V<re;V++){let X=K[V],te=q[X.materialIndex];if(te&&te.visible){let ie=R(E,te,k,D);E.onBeforeShadow(i,E,g,b,P,ie,X),i.renderBufferDirect(b,null,P,ie,E,X),E.onAfterShadow(i,E,g,b,P,ie,X)}}}else if(q.visible){let K=R(E,q,k,D);E.onBeforeShadow(i,E,g,b,P,K,null),i.renderBufferDirect(b,null,P,K,E,null),E.onAfterShadow(i,E,g,b,P,K,null)}}let $=E.children;for(let P=0,q=$.length;P<q;P++)w($[P],g,b,k,L,D)}function T(E){E.target.removeEventListener("dispose",T);for(let b in c){let k=c[b],L=E.target.uuid;L in k&&(k[L].dispose(),delete k[L])}}}function Ov(i,e){function t(){let A=!1,J=new dt,H=null,ue=new dt(0,0,0,0);return{setMask:function(ae){H!==ae&&!A&&(i.colorMask(ae,ae,ae,ae),H=ae)},setLocked:function(ae){A=ae},setClear:function(ae,ce,Te,Ge,oe){oe===!0&&(ae*=Ge,ce*=Ge,Te*=Ge),J.set(ae,ce,Te,Ge),ue.equals(J)===!1&&(i.clearColor(ae,ce,Te,Ge),ue.copy(J))},reset:function(){A=!1,H=null,ue.set(-1,0,0,0)}}}function n(){let A=!1,J=!1,H=null,ue=null,ae=null;return{setReversed:function(ce){if(J!==ce){let Te=e.get("EXT_clip_control");ce?Te.clipControlEXT(Te.LOWER_LEFT_EXT,Te.ZERO_TO_ONE_EXT):Te.clipControlEXT(Te.LOWER_LEFT_EXT,Te.NEGATIVE_ONE_TO_ONE_EXT),J=ce;let Ge=ae;ae=null,this.setClear(Ge)}},getReversed:function(){return J},setTest:function(ce){ce?ye(i.DEPTH_TEST):ke(i.DEPTH_TEST)},setMask:function(ce){H!==ce&&!A&&(i.depthMask(ce),H=ce)},setFunc:function(ce){if(J&&(ce=ou[ce]),ue!==ce){switch(ce){case qr:i.depthFunc(i.NEVER);break;case Yr:i.depthFunc(i.ALWAYS);break;case $r:i.depthFunc(i.LESS);break;case es:i.depthFunc(i.LEQUAL);break;case Zr:i.depthFunc(i.EQUAL);break;case jr:i.depthFunc(i.GEQUAL);break;case Jr:i.depthFunc(i.GREATER);break;case Kr:i.depthFunc(i.NOTEQUAL);break;default:i.depthFunc(i.LEQUAL)}ue=ce}},setLocked:function(ce){A=ce},setClear:function(ce){ae!==ce&&(ae=ce,J&&(ce=1-ce),i.clearDepth(ce))},reset:function(){A=!1,H=null,ue=null,ae=null,J=!1}}}function s(){let A=!1,J=null,H=null,ue=null,ae=null,ce=null,Te=null,Ge=null,oe=null;return{setTest:function(Re){A||(Re?ye(i.STENCIL_TEST):ke(i.STENCIL_TEST))},setMask:function(Re){J!==Re&&!A&&(i.stencilMask(Re),J=Re)},setFunc:function(Re,ze,ge){(H!==Re||ue!==ze||ae!==ge)&&(i.stencilFunc(Re,ze,ge),H=Re,ue=ze,ae=ge)},setOp:function(Re,ze,ge){(ce!==Re||Te!==ze||Ge!==ge)&&(i.stencilOp(Re,ze,ge),ce=Re,Te=ze,Ge=ge)},setLocked:function(Re){A=Re},setClear:function(Re){oe!==Re&&(i.clearStencil(Re),oe=Re)},reset:function(){A=!1,J=null,H=null,ue=null,ae=null,ce=null,Te=null,Ge=null,oe=null}}}let r=new t,o=new n,a=new s,l={},c=new WeakMap,h={},d={},u={},f=new WeakMap,v=[],S=null,m=!1,p=null,_=null,R=null,w=null,T=null,E=null,g=null,b=new Ze(0,0,0),k=0,L=!1,D=null,G=null,$=null,P=null,q=null,K=i.getParameter(i.MAX_COMBINED_TEXTURE_IMAGE_UNITS),V=!1,re=0,X=i.getParameter(i.VERSION);X.indexOf("WebGL")!==-1?(re=parseFloat(/^WebGL (\d)/.exec(X)[1]),V=re>=1):X.indexOf("OpenGL ES")!==-1&&(re=parseFloat(/^OpenGL ES (\d)/.exec(X)[1]),V=re>=2);let te=null,ie={},Ee=i.getParameter(i.SCISSOR_BOX),Fe=i.getParameter(i.VIEWPORT),j=new dt().fromArray(Ee),xe=new dt().fromArray(Fe);function be(A,J,H,ue){let ae=new Uint8Array(4),ce=i.createTexture();i.bindTexture(A,ce),i.texParameteri(A,i.TEXTURE_MIN_FILTER,i.NEAREST),i.texParameteri(A,i.TEXTURE_MAG_FILTER,i.NEAREST);for(let Te=0;Te<H;Te++)A===i.TEXTURE_3D||A===i.TEXTURE_2D_ARRAY?i.texImage3D(J,0,i.RGBA,1,1,ue,0,i.RGBA,i.UNSIGNED_BYTE,ae):i.texImage2D(J+Te,0,i.RGBA,1,1,0,i.RGBA,i.UNSIGNED_BYTE,ae);return ce}let Pe={};Pe[i.TEXTURE_2D]=be(i.TEXTURE_2D,i.TEXTURE_2D,1),Pe[i.TEXTURE_CUBE_MAP]=be(i.TEXTURE_CUBE_MAP,i.TEXTURE_CUBE_MAP_POSITIVE_X,6),Pe[i.TEXTURE_2D_ARRAY]=be(i.TEXTURE_2D_ARRAY,i.TEXTURE_2D_ARRAY,1,1),Pe[i.TEXTURE_3D]=be(i.TEXTURE_3D,i.TEXTURE_3D,1,1),r.setClear(0,0,0,1),o.setClear(1),a.setClear(0),ye(i.DEPTH_TEST),o.setFunc(es),Xt(!1),ct(fl),ye(i.CULL_FACE),Ct(Pi);function ye(A){h[A]!==!0&&(i.enable(A),h[A]=!0)}function ke(A){h[A]!==!1&&(i.disable(A),h[A]=!1)}function pt(A,J){return u[A]!==J?(i.bindFramebuffer(A,J),u[A]=J,A===i.DRAW_FRAMEBUFFER&&(u[i.FRAMEBUFFER]=J),A===i.FRAMEBUFFER&&(u[i.DRAW_FRAMEBUFFER]=J),!0):!1}function Ie(A,J){let H=v,ue=!1;if(A){H=f.get(J),H===void 0&&(H=[],f.set(J,H));let ae=A.textures;if(H.length!==ae.length||H[0]!==i.COLOR_ATTACHMENT0){for(let ce=0,Te=ae.length;ce<Te;ce++)H[ce]=i.COLOR_ATTACHMENT0+ce;H.length=ae.length,ue=!0}}else H[0]!==i.BACK&&(H[0]=i.BACK,ue=!0);ue&&i.drawBuffers(H)}function et(A){return S!==A?(i.useProgram(A),S=A,!0):!1}let nt={[Li]:i.FUNC_ADD,[Rh]:i.FUNC_SUBTRACT,[Ch]:i.FUNC_REVERSE_SUBTRACT};nt[Ph]=i.MIN,nt[Lh]=i.MAX;let We={[Ih]:i.ZERO,[Nh]:i.ONE,[Dh]:i.SRC_COLOR,[vl]:i.SRC_ALPHA,[zh]:i.SRC_ALPHA_SATURATE,[Bh]:i.DST_COLOR,[Oh]:i.DST_ALPHA,[Uh]:i.ONE_MINUS_SRC_COLOR,[xl]:i.ONE_MINUS_SRC_ALPHA,[kh]:i.ONE_MINUS_DST_COLOR,[Fh]:i.ONE_MINUS_DST_ALPHA,[Gh]:i.CONSTANT_COLOR,[Vh]:i.ONE_MINUS_CONSTANT_COLOR,[Hh]:i.CONSTANT_ALPHA,[Wh]:i.ONE_MINUS_CONSTANT_ALPHA};function Ct(A,J,H,ue,ae,ce,Te,Ge,oe,Re){if(A===Pi){m===!0&&(ke(i.BLEND),m=!1);return}if(m===!1&&(ye(i.BLEND),m=!0),A!==Th){if(A!==p||Re!==L){if((_!==Li||T!==Li)&&(i.blendEquation(i.FUNC_ADD),_=Li,T=Li),Re)switch(A){case hs:i.blendFuncSeparate(i.ONE,i.ONE_MINUS_SRC_ALPHA,i.ONE,i.ONE_MINUS_SRC_ALPHA);break;case pl:i.blendFunc(i.ONE,i.ONE);break;case ml:i.blendFuncSeparate(i.ZERO,i.ONE_MINUS_SRC_COLOR,i.ZERO,i.ONE);break;case gl:i.blendFuncSeparate(i.DST_COLOR,i.ONE_MINUS_SRC_ALPHA,i.ZERO,i.ONE);break;default:Ne("WebGLState: Invalid blending: ",A);break}else switch(A){case hs:i.blendFuncSeparate(i.SRC_ALPHA,i.ONE_MINUS_SRC_ALPHA,i.ONE,i.ONE_MINUS_SRC_ALPHA);break;case pl:i.blendFuncSeparate(i.SRC_ALPHA,i.ONE,i.ONE,i.ONE);break;case ml:Ne("WebGLState: SubtractiveBlending requires material.premultipliedAlpha = true");break;case gl:Ne("WebGLState: MultiplyBlending requires material.premultipliedAlpha = true");break;default:Ne("WebGLState: Invalid blending: ",A);break}R=null,w=null,E=null,g=null,b.set(0,0,0),k=0,p=A,L=Re}return}ae=ae||J,ce=ce||H,Te=Te||ue,(J!==_||ae!==T)&&(i.blendEquationSeparate(nt[J],nt[ae]),_=J,T=ae),(H!==R||ue!==w||ce!==E||Te!==g)&&(i.blendFuncSeparate(We[H],We[ue],We[ce],We[Te]),R=H,w=ue,E=ce,g=Te),(Ge.equals(b)===!1||oe!==k)&&(i.blendColor(Ge.r,Ge.g,Ge.b,oe),b.copy(Ge),k=oe),p=A,L=!1}function vt(A,J){A.side===Wt?ke(i.CULL_FACE):ye(i.CULL_FACE);let H=A.side===Nt;J&&(H=!H),Xt(H),A.blending===hs&&A.transparent===!1?Ct(Pi):Ct(A.blending,A.blendEquation,A.blendSrc,A.blendDst,A.blendEquationAlpha,A.blendSrcAlpha,A.blendDstAlpha,A.blendColor,A.blendAlpha,A.premultipliedAlpha),o.setFunc(A.depthFunc),o.setTest(A.depthTest),o.setMask(A.depthWrite),r.setMask(A.colorWrite);let ue=A.stencilWrite;a.setTest(ue),ue&&(a.setMask(A.stencilWriteMask),a.setFunc(A.stencilFunc,A.stencilRef,A.stencilFuncMask),a.setOp(A.stencilFail,A.stencilZFail,A.stencilZPass)),_t(A.polygonOffset,A.polygonOffsetFactor,A.polygonOffsetUnits),A.alphaToCoverage===!0?ye(i.SAMPLE_ALPHA_TO_COVERAGE):ke(i.SAMPLE_ALPHA_TO_COVERAGE)}function Xt(A){D!==A&&(A?i.frontFace(i.CW):i.frontFace(i.CCW),D=A)}function ct(A){A!==wh?(ye(i.CULL_FACE),A!==G&&(A===fl?i.cullFace(i.BACK):A===Eh?i.cullFace(i.FRONT):i.cullFace(i.FRONT_AND_BACK))):ke(i.CULL_FACE),G=A}function _n(A){A!==$&&(V&&i.lineWidth(A),$=A)}function _t(A,J,H){A?(ye(i.POLYGON_OFFSET_FILL),(P!==J||q!==H)&&(P=J,q=H,o.getReversed()&&(J=-J,H=-H),i.polygonOffset(J,H))):ke(i.POLYGON_OFFSET_FILL)}function rn(A){A?ye(i.SCISSOR_TEST):ke(i.SCISSOR_TEST)}function on(A){A===void 0&&(A=i.TEXTURE0+K-1),te!==A&&(i.activeTexture(A),te=A)}function an(A,J,H){H===void 0&&(te===null?H=i.TEXTURE0+K-1:H=te);let ue=ie[H];ue===void 0&&(ue={type:void 0,texture:void 0},ie[H]=ue),(ue.type!==A||ue.texture!==J)&&(te!==H&&(i.activeTexture(H),te=H),i.bindTexture(A,J||Pe[A]),ue.type=A,ue.texture=J)}function I(){let A=ie[te];A!==void 0&&A.type!==void 0&&(i.bindTexture(A.type,null),A.type=void 0,A.texture=void 0)}function ln(){try{i.compressedTexImage2D(...arguments)}catch(A){Ne("WebGLState:",A)}}function ot(){try{i.compressedTexImage3D(...arguments)}catch(A){Ne("WebGLState:",A)}}function at(){try{i.texSubImage2D(...arguments)}catch(A){Ne("WebGLState:",A)}}function me(){try{i.texSubImage3D(...arguments)}catch(A){Ne("WebGLState:",A)}}function xt(){try{i.compressedTexSubImage2D(...arguments)}catch(A){Ne("WebGLState:",A)}}function Le(){try{i.compressedTexSubImage3D(...arguments)}catch(A){Ne("WebGLState:",A)}}function Oe(){try{i.texStorage2D(...arguments)}catch(A){Ne("WebGLState:",A)}}function M(){try{i.texStorage3D(...arguments)}catch(A){Ne("WebGLState:",A)}}function x(){try{i.texImage2D(...arguments)}catch(A){Ne("WebGLState:",A)}}function O(){try{i.texImage3D(...arguments)}catch(A){Ne("WebGLState:",A)}}function se(A){return d[A]!==void 0?d[A]:i.getParameter(A)}function ee(A,J){d[A]!==J&&(i.pixelStorei(A,J),d[A]=J)}function le(A){j.equals(A)===!1&&(i.scissor(A.x,A.y,A.z,A.w),j.copy(A))}function fe(A){xe.equals(A)===!1&&(i.viewport(A.x,A.y,A.z,A.w),xe.copy(A))}function Y(A,J){let H=c.get(J);H===void 0&&(H=new WeakMap,c.set(J,H));let ue=H.get(A);ue===void 0&&(ue=i.getUniformBlockIndex(J,A.name),i.uniformBlockBinding(J,ue,ue),H.set(A,ue))}function Z(A,J,H){let ae=c.get(J).get(A);l[ae]!==H&&(i.bindBufferBase(i.UNIFORM_BUFFER,ae,H),l[ae]=H)}function he(){i.disable(i.BLEND),i.disable(i.CULL_FACE),i.disable(i.DEPTH_TEST),i.disable(i.POLYGON_OFFSET_FILL),i.disable(i.SCISSOR_TEST),i.disable(i.STENCIL_TEST),i.disable(i.SAMPLE_ALPHA_TO_COVERAGE),i.blendEquation(i.FUNC_ADD),i.blendFunc(i.ONE,i.ZERO),i.blendFuncSeparate(i.ONE,i.ZERO,i.ONE,i.ZERO),i.blendColor(0,0,0,0),i.colorMask(!0,!0,!0,!0),i.clearColor(0,0,0,0),i.depthMask(!0),i.depthFunc(i.LESS),o.setReversed(!1),i.clearDepth(1),i.stencilMask(4294967295),i.stencilFunc(i.ALWAYS,0,4294967295),i.stencilOp(i.KEEP,i.KEEP,i.KEEP),i.clearStencil(0),i.cullFace(i.BACK),i.frontFace(i.CCW),i.polygonOffset(0,0),i.activeTexture(i.TEXTURE0),i.bindFramebuffer(i.FRAMEBUFFER,null),i.bindFramebuffer(i.DRAW_FRAMEBUFFER,null),i.bindFramebuffer(i.READ_FRAMEBUFFER,null),i.useProgram(null),i.lineWidth(1),i.scissor(0,0,i.canvas.width,i.canvas.height),i.viewport(0,0,i.canvas.width,i.canvas.height),i.pixelStorei(i.PACK_ALIGNMENT,4),i.pixelStorei(i.UNPACK_ALIGNMENT,4),i.pixelStorei(i.UNPACK_FLIP_Y_WEBGL,!1),i.pixelStorei(i.UNPACK_PREMULTIPLY_ALPHA_WEBGL,!1),i.pixelStorei(i.UNPACK_COLORSPACE_CONVERSION_WEBGL,i.BROWSER_DEFAULT_WEBGL),i.pixelStorei(i.PACK_ROW_LENGTH,0),i.pixelStorei(i.PACK_SKIP_PIXELS,0),i.pixelStorei(i.PACK_SKIP_ROWS,0),i.pixelStorei(i.UNPACK_ROW_LENGTH,0),i.pixelStorei(i.UNPACK_IMAGE_HEIGHT,0),i.pixelStorei(i.UNPACK_SKIP_PIXELS,0),i.pixelStorei(i.UNPACK_SKIP_ROWS,0),i.pixelStorei(i.UNPACK_SKIP_IMAGES,0),h={},d={},te=null,ie={},u={},l={},f=new WeakMap,v=[],S=null,m=!1,p=null,_=null,R=null,w=null,T=null,E=null,g=null,b=new Ze(0,0,0),k=0,L=!1,D=null,G=null,$=null,P=null,q=null,j.set(0,0,i.canvas.width,i.canvas.height),xe.set(0,0,i.canvas.width,i.canvas.height),r.reset(),o.reset(),a.reset()}return{buffers:{color:r,depth:o,stencil:a},enable:ye,disable:ke,bindFramebuffer:pt,drawBuffers:Ie,useProgram:et,setBlending:Ct,setMaterial:vt,setFlipSided:Xt,setCullFace:ct,setLineWidth:_n,setPolygonOffset:_t,setScissorTest:rn,activeTexture:on,bindTexture:an,unbindTexture:I,compressedTexImage2D:ln,compressedTexImage3D:ot,texImage2D:x,texImage3D:O,pixelStorei:ee,getParameter:se,updateUBOMapping:Y,uniformBlockBinding:Z,texStorage2D:Oe,texStorage3D:M,texSubImage2D:at,texSubImage3D:me,compressedTexSubImage2D:xt,compressedTexSubImage3D:Le,scissor:le,viewport:fe,reset:he}}function Fv(i,e,t,n,s,r,o){let a=e.has("WEBGL_multisampled_render_to_texture")?e.get("WEBGL_multisampled_render_to_texture"):null,l=typeof navigator>"u"?!1:/OculusBrowser/g.test(navigator.userAgent),c=new De,h=new WeakMap,d=new Set,u,f=new WeakMap,v=new Set,S=new FinalizationRegistry(M=>v.delete(M)),m=!1;try{m=typeof OffscreenCanvas<"u"&&new OffscreenCanvas(1,1).getContext("2d")!==null}catch{}function p(M,x){return m?new OffscreenCanvas(M,x):Ds("canvas")}function _(M,x,O){let se=1,ee=Oe(M);if((ee.width>O||ee.height>O)&&(se=O/Math.max(ee.width,ee.height)),se<1)if(typeof HTMLImageElement<"u"&&M instanceof HTMLImageElement||typeof HTMLCanvasElement<"u"&&M instanceof HTMLCanvasElement||typeof ImageBitmap<"u"&&M instanceof ImageBitmap||typeof VideoFrame<"u"&&M instanceof VideoFrame){let le=Math.floor(se*ee.width),fe=Math.floor(se*ee.height);u===void 0&&(u=p(le,fe));let Y=x?p(le,fe):u;return Y.width=le,Y.height=fe,Y.getContext("2d").drawImage(M,0,0,le,fe),Ce("WebGLRenderer: Texture has been resized from ("+ee.width+"x"+ee.height+") to ("+le+"x"+fe+")."),Y}else return"data"in M&&Ce("WebGLRenderer: Image in DataTexture is too big ("+ee.width+"x"+ee.height+")."),M;return M}function R(M){return M.generateMipmaps}function w(M){i.generateMipmap(M)}function T(M){return M.isWebGLCubeRenderTarget?i.TEXTURE_CUBE_MAP:M.isWebGL3DRenderTarget?i.TEXTURE_3D:M.isWebGLArrayRenderTarget||M.isCompressedArrayTexture?i.TEXTURE_2D_ARRAY:i.TEXTURE_2D}function E(M,x,O,se,ee,le=!1){if(M!==null){if(i[M]!==void 0)return i[M];Ce("WebGLRenderer: Attempt to use non-existing WebGL internal format '"+M+"'")}let fe;se&&(fe=e.get("EXT_texture_norm16"),fe||Ce("WebGLRenderer: Unable to use normalized textures without EXT_texture_norm16 extension"));let Y=x;if(x===i.RED&&(O===i.FLOAT&&(Y=i.R32F),O===i.HALF_FLOAT&&(Y=i.R16F),O===i.UNSIGNED_BYTE&&(Y=i.R8),O===i.UNSIGNED_SHORT&&fe&&(Y=fe.R16_EXT),O===i.SHORT&&fe&&(Y=fe.R16_SNORM_EXT)),x===i.RED_INTEGER&&(O===i.UNSIGNED_BYTE&&(Y=i.R8UI),O===i.UNSIGNED_SHORT&&(Y=i.R16UI),O===i.UNSIGNED_INT&&(Y=i.R32UI),O===i.BYTE&&(Y=i.R8I),O===i.SHORT&&(Y=i.R16I),O===i.INT&&(Y=i.R32I)),x===i.RG&&(O===i.FLOAT&&(Y=i.RG32F),O===i.HALF_FLOAT&&(Y=i.RG16F),O===i.UNSIGNED_BYTE&&(Y=i.RG8),O===i.UNSIGNED_SHORT&&fe&&(Y=fe.RG16_EXT),O===i.SHORT&&fe&&(Y=fe.RG16_SNORM_EXT)),x===i.RG_INTEGER&&(O===i.UNSIGNED_BYTE&&(Y=i.RG8UI),O===i.UNSIGNED_SHORT&&(Y=i.RG16UI),O===i.UNSIGNED_INT&&(Y=i.RG32UI),O===i.BYTE&&(Y=i.RG8I),O===i.SHORT&&(Y=i.RG16I),O===i.INT&&(Y=i.RG32I)),x===i.RGB_INTEGER&&(O===i.UNSIGNED_BYTE&&(Y=i.RGB8UI),O===i.UNSIGNED_SHORT&&(Y=i.RGB16UI),O===i.UNSIGNED_INT&&(Y=i.RGB32UI),O===i.BYTE&&(Y=i.RGB8I),O===i.SHORT&&(Y=i.RGB16I),O===i.INT&&(Y=i.RGB32I)),x===i.RGBA_INTEGER&&(O===i.UNSIGNED_BYTE&&(Y=i.RGBA8UI),O===i.UNSIGNED_SHORT&&(Y=i.RGBA16UI),O===i.UNSIGNED_INT&&(Y=i.RGBA32UI),O===i.BYTE&&(Y=i.RGBA8I),O===i.SHORT&&(Y=i.RGBA16I),O===i.INT&&(Y=i.RGBA32I)),x===i.RGB&&(O===i.UNSIGNED_SHORT&&fe&&(Y=fe.RGB16_EXT),O===i.SHORT&&fe&&(Y=fe.RGB16_SNORM_EXT),O===i.UNSIGNED_INT_5_9_9_9_REV&&(Y=i.RGB9_E5),O===i.UNSIGNED_INT_10F_11F_11F_REV&&(Y=i.R11F_G11F_B10F)),x===i.RGBA){let Z=le?Is:Ye.getTransfer(ee);O===i.FLOAT&&(Y=i.RGBA32F),O===i.HALF_FLOAT&&(Y=i.RGBA16F),O===i.UNSIGNED_BYTE&&(Y=Z===Qe?i.SRGB8_ALPHA8:i.RGBA8),O===i.UNSIGNED_SHORT&&fe&&(Y=fe.RGBA16_EXT),O===i.SHORT&&fe&&(Y=fe.RGBA16_SNORM_EXT),O===i.UNSIGNED_SHORT_4_4_4_4&&(Y=i.RGBA4),O===i.UNSIGNED_SHORT_5_5_5_1&&(Y=i.RGB5_A1)}return(Y===i.R16F||Y===i.R32F||Y===i.RG16F||Y===i.RG32F||Y===i.RGBA16F||Y===i.RGBA32F)&&e.get("EXT_color_buffer_float"),Y}function g(M,x){let O;return M?x===null||x===yn||x===Ni?O=i.DEPTH24_STENCIL8:x===Sn?O=i.DEPTH32F_STENCIL8:x===ds&&(O=i.DEPTH24_STENCIL8,Ce("DepthTexture: 16 bit depth attachment is not supported with stencil. Using 24-bit attachment.")):x===null||x===yn||x===Ni?O=i.DEPTH_COMPONENT24:x===Sn?O=i.DEPTH_COMPONENT32F:x===ds&&(O=i.DEPTH_COMPONENT16),O}function b(M,x){return R(M)===!0||M.isFramebufferTexture&&M.minFilter!==Tt&&M.minFilter!==Vt?Math.log2(Math.max(x.width,x.height))+1:M.mipmaps.length>0?M.mipmaps.length:M.isCompressedTexture&&Array.isArray(M.image)?x.mipmaps.length:1}function k(M){let x=new WeakRef(M);n.get(M).Is=x,v.add(x),S.register(M,x,x)}function L(M){let x=n.get(M).Is;x!==void 0&&(v.delete(x),S.unregister(x))}function D(M){$(M.target)}function G(M){P(M.target)}function $(M){M.removeEventListener("dispose",D),L(M),K(M),M.isVideoTexture&&h.delete(M),M.isHTMLTexture&&d.delete(M)}function P(M){M.removeEventListener("dispose",G),L(M),re(M)}function q(){for(let M of v){let x=M.deref();x!==void 0&&(x.isRenderTarget===!0?P(x):$(x))}v.clear(),d.clear()}function K(M){let x=n.get(M);if(x.hi===void 0)return;let O=M.source,se=f.get(O);if(se){let ee=se[x.dt];ee.usedTimes--,ee.usedTimes===0&&V(M),Object.keys(se).length===0&&f.delete(O)}n.remove(M)}function V(M){let x=n.get(M);i.deleteTexture(x._);let O=M.source,se=f.get(O);delete se[x.dt],o.memory.textures--}function re(M){let x=n.get(M);x.pt&&x.pt();let O=M.depthTexture;if(O&&O.renderTarget===M&&$(O),M.isWebGLCubeRenderTarget)for(let ee=0;ee<6;ee++){if(Array.isArray(x.M[ee]))for(let le=0;le<x.M[ee].length;le++)i.deleteFramebuffer(x.M[ee][le]);else i.deleteFramebuffer(x.M[ee]);x.Z&&i.deleteRenderbuffer(x.Z[ee])}else{if(Array.isArray(x.M))for(let ee=0;ee<x.M.length;ee++)i.deleteFramebuffer(x.M[ee]);else i.deleteFramebuffer(x.M);if(x.Z&&i.deleteRenderbuffer(x.Z),x.ve&&i.deleteFramebuffer(x.ve),x.re)for(let ee=0;ee<x.re.length;ee++)x.re[ee]&&i.deleteRenderbuffer(x.re[ee]);x.cn&&i.deleteRenderbuffer(x.cn)}let se=M.textures;for(let ee=0,le=se.length;ee<le;ee++){let fe=n.get(se[ee]);fe._&&(i.deleteTexture(fe._),o.memory.textures--),n.remove(se[ee])}n.remove(M)}let X=0;function te(){X=0}function ie(){return X}function Ee(M){X=M}function Fe(){let M=X;return M>=s.maxTextures&&Ce("WebGLTextures: Trying to use "+(M+1)+" texture units while this GPU supports only "+s.maxTextures),X+=1,M}function j(M){let x=[];return x.push(M.wrapS),x.push(M.wrapT),x.push(M.wrapR||0),x.push(M.magFilter),x.push(M.minFilter),x.push(M.anisotropy),x.push(M.internalFormat),x.push(M.format),x.push(M.type),x.push(M.generateMipmaps),x.push(M.mipmapsAutoUpdate),x.push(M.premultiplyAlpha),x.push(M.flipY),x.push(M.unpackAlignment),x.push(M.colorSpace),x.join()}function xe(M,x){let O=n.get(M);if(M.isVideoTexture&&xt(M),M.isRenderTargetTexture===!1&&M.isExternalTexture!==!0&&M.version>0&&O.X!==M.version){let se=M.image;if(se===null)Ce("WebGLRenderer: Texture marked for update but no image data found.");else if(se.complete===!1)Ce("WebGLRenderer: Texture marked for update but image is incomplete");else{vt(O,M,x);return}}else M.isExternalTexture&&(O._=M.sourceTexture?M.sourceTexture:null);t.bindTexture(i.TEXTURE_2D,O._,i.TEXTURE0+x)}function be(M,x){let O=n.get(M);if(M.isRenderTargetTexture===!1&&M.version>0&&O.X!==M.version){vt(O,M,x);return}else M.isExternalTexture&&(O._=M.sourceTexture?M.sourceTexture:null);t.bindTexture(i.TEXTURE_2D_ARRAY,O._,i.TEXTURE0+x)}function Pe(M,x){let O=n.get(M);if(M.isRenderTargetTexture===!1&&M.version>0&&O.X!==M.version){vt(O,M,x);return}t.bindTexture(i.TEXTURE_3D,O._,i.TEXTURE0+x)}function ye(M,x){let O=n.get(M);if(M.version>0&&O.X!==M.version){Xt(O,M,x);return}t.bindTexture(i.TEXTURE_CUBE_MAP,O._,i.TEXTURE0+x)}let ke={[Qr]:i.REPEAT,[An]:i.CLAMP_TO_EDGE,[eo]:i.MIRRORED_REPEAT},pt={[Tt]:i.NEAREST,[Yh]:i.NEAREST_MIPMAP_NEAREST,[js]:i.NEAREST_MIPMAP_LINEAR,[Vt]:i.LINEAR,[Co]:i.LINEAR_MIPMAP_NEAREST,[qn]:i.LINEAR_MIPMAP_LINEAR},Ie={[Jh]:i.NEVER,[Bl]:i.ALWAYS,[Kh]:i.LESS,[Ol]:i.LEQUAL,[Qh]:i.EQUAL,[Fl]:i.GEQUAL,[eu]:i.GREATER,[tu]:i.NOTEQUAL};function et(M,x){if(x.type===Sn&&e.has("OES_texture_float_linear")===!1&&(x.magFilter===Vt||x.magFilter===Co||x.magFilter===js||x.magFilter===qn||x.minFilter===Vt||x.minFilter===Co||x.minFilter===js||x.minFilter===qn)&&Ce("WebGLRenderer: Unable to use linear filtering with floating point textures. OES_texture_float_linear not supported on this device."),i.texParameteri(M,i.TEXTURE_WRAP_S,ke[x.wrapS]),i.texParameteri(M,i.TEXTURE_WRAP_T,ke[x.wrapT]),(M===i.TEXTURE_3D||M===i.TEXTURE_2D_ARRAY)&&i.texParameteri(M,i.TEXTURE_WRAP_R,ke[x.wrapR]),i.texParameteri(M,i.TEXTURE_MAG_FILTER,pt[x.magFilter]),i.texParameteri(M,i.TEXTURE_MIN_FILTER,pt[x.minFilter]),x.compareFunction&&(i.texParameteri(M,i.TEXTURE_COMPARE_MODE,i.COMPARE_REF_TO_TEXTURE),i.texParameteri(M,i.TEXTURE_COMPARE_FUNC,Ie[x.compareFunction])),e.has("EXT_texture_filter_anisotropic")===!0){if(x.magFilter===Tt||x.minFilter!==js&&x.minFilter!==qn||x.type===Sn&&e.has("OES_texture_float_linear")===!1)return;if(x.anisotropy>1||n.get(x).Ns){let O=e.get("EXT_texture_filter_anisotropic");i.texParameterf(M,O.TEXTURE_MAX_ANISOTROPY_EXT,Math.min(x.anisotropy,s.getMaxAnisotropy())),n.get(x).Ns=x.anisotropy}}}function nt(M,x){let O=!1;M.hi===void 0&&(M.hi=!0,x.addEventListener("dispose",D),k(x));let se=x.source,ee=f.get(se);ee===void 0&&(ee={},f.set(se,ee));let le=j(x);if(le!==M.dt){ee[le]===void 0&&(ee[le]={texture:i.createTexture(),usedTimes:0},o.memory.textures++,O=!0),ee[le].usedTimes++;let fe=ee[M.dt];fe!==void 0&&(ee[M.dt].usedTimes--,fe.usedTimes===0&&V(x)),M.dt=le,M._=ee[le].texture}return O}function We(M,x,O){return Math.floor(Math.floor(M/O)/x)}function Ct(M,x,O,se){let le=M.updateRanges;if(le.length===0)t.texSubImage2D(i.TEXTURE_2D,0,0,0,x.width,x.height,O,se,x.data);else{le.sort((A,J)=>A.start-J.start);let fe=0;for(let A=1;A<le.length;A++){let J=le[fe],H=le[A],ue=J.start+J.count,ae=We(H.start,x.width,4),ce=We(J.start,x.width,4);H.start<=ue+1&&ae===ce&&We(H.start+H.count-1,x.width,4)===ae?J.count=Math.max(J.count,H.start+H.count-J.start):(++fe,le[fe]=H)}le.length=fe+1;let Y=t.getParameter(i.UNPACK_ROW_LENGTH),Z=t.getParameter(i.UNPACK_SKIP_PIXELS),he=t.getParameter(i.UNPACK_SKIP_ROWS);t.pixelStorei(i.UNPACK_ROW_LENGTH,x.width);for(let A=0,J=le.length;A<J;A++){let H=le[A],ue=Math.floor(H.start/4),ae=Math.ceil(H.count/4),ce=ue%x.width,Te=Math.floor(ue/x.width),Ge=ae,oe=1;t.pixelStorei(i.UNPACK_SKIP_PIXELS,ce),t.pixelStorei(i.UNPACK_SKIP_ROWS,Te),t.texSubImage2D(i.TEXTURE_2D,0,ce,Te,Ge,oe,O,se,x.data)}M.clearUpdateRanges(),t.pixelStorei(i.UNPACK_ROW_LENGTH,Y),t.pixelStorei(i.UNPACK_SKIP_PIXELS,Z),t.pixelStorei(i.UNPACK_SKIP_ROWS,he)}}function vt(M,x,O){let se=i.TEXTURE_2D;(x.isDataArrayTexture||x.isCompressedArrayTexture)&&(se=i.TEXTURE_2D_ARRAY),x.isData3DTexture&&(se=i.TEXTURE_3D);let ee=nt(M,x),le=x.source;t.bindTexture(se,M._,i.TEXTURE0+O);let fe=n.get(le);if(le.version!==fe.X||ee===!0){if(t.activeTexture(i.TEXTURE0+O),(typeof ImageBitmap<"u"&&x.image instanceof ImageBitmap)===!1){let oe=Ye.getPrimaries(Ye.workingColorSpace),Re=x.colorSpace===$n?null:Ye.getPrimaries(x.colorSpace),ze=x.colorSpace===$n||oe===Re?i.NONE:i.BROWSER_DEFAULT_WEBGL;t.pixelStorei(i.UNPACK_FLIP_Y_WEBGL,x.flipY),t.pixelStorei(i.UNPACK_PREMULTIPLY_ALPHA_WEBGL,x.premultiplyAlpha),t.pixelStorei(i.UNPACK_COLORSPACE_CONVERSION_WEBGL,ze)}t.pixelStorei(i.UNPACK_ALIGNMENT,x.unpackAlignment);let Z=_(x.image,!1,s.maxTextureSize);Z=Le(x,Z);let he=r.convert(x.format,x.colorSpace),A=r.convert(x.type),J=E(x.internalFormat,he,A,x.normalized,x.colorSpace,x.isVideoTexture);et(se,x);let H,ue=x.mipmaps,ae=x.isVideoTexture!==!0,ce=fe.X===void 0||ee===!0,Te=le.dataReady,Ge=b(x,Z);if(x.isDepthTexture)J=g(x.format===Yn,x.type),ce&&(ae?t.texStorage2D(i.TEXTURE_2D,1,J,Z.width,Z.height):t.texImage2D(i.TEXTURE_2D,0,J,Z.width,Z.height,0,he,A,null));else if(x.isDataTexture)if(ue.length>0){ae&&ce&&t.texStorage2D(i.TEXTURE_2D,Ge,J,ue[0].width,ue[0].height);for(let oe=0,Re=ue.length;oe<Re;oe++)H=ue[oe],ae?Te&&t.texSubImage2D(i.TEXTURE_2D,oe,0,0,H.width,H.height,he,A,H.data):t.texImage2D(i.TEXTURE_2D,oe,J,H.width,H.height,0,he,A,H.data);x.generateMipmaps=!1}else ae?(ce&&t.texStorage2D(i.TEXTURE_2D,Ge,J,Z.width,Z.height),Te&&Ct(x,Z,he,A)):t.texImage2D(i.TEXTURE_2D,0,J,Z.width,Z.height,0,he,A,Z.data);else if(x.isCompressedTexture)if(x.isCompressedArrayTexture){ae&&ce&&t.texStorage3D(i.TEXTURE_2D_ARRAY,Ge,J,ue[0].width,ue[0].height,Z.depth);for(let oe=0,Re=ue.length;oe<Re;oe++)if(H=ue[oe],x.format!==bn)if(he!==null)if(ae){if(Te)if(x.layerUpdates.size>0){let ze=Yl(H.width,H.height,x.format,x.type);for(let ge of x.layerUpdates){let tt=H.data.subarray(ge*ze/H.data.BYTES_PER_ELEMENT,(ge+1)*ze/H.data.BYTES_PER_ELEMENT);t.compressedTexSubImage3D(i.TEXTURE_2D_ARRAY,oe,0,0,ge,H.width,H.height,1,he,tt)}}else t.compressedTexSubImage3D(i.TEXTURE_2D_ARRAY,oe,0,0,0,H.width,H.height,Z.depth,he,H.data)}else t.compressedTexImage3D(i.TEXTURE_2D_ARRAY,oe,J,H.width,H.height,Z.depth,0,H.data,0,0);else Ce("WebGLRenderer: Attempt to load unsupported compressed texture format in .uploadTexture()");else ae?Te&&t.texSubImage3D(i.TEXTURE_2D_ARRAY,oe,0,0,0,H.width,H.height,Z.depth,he,A,H.data):t.texImage3D(i.TEXTURE_2D_ARRAY,oe,J,H.width,H.height,Z.depth,0,he,A,H.data);x.layerUpdates.size>0&&x.clearLayerUpdates()}else{ae&&ce&&t.texStorage2D(i.TEXTURE_2D,Ge,J,ue[0].width,ue[0].height);for(let oe=0,Re=ue.length;oe<Re;oe++)H=ue[oe],x.format!==bn?he!==null?ae?Te&&t.compressedTexSubImage2D(i.TEXTURE_2D,oe,0,0,H.width,H.height,he,H.data):t.compressedTexImage2D(i.TEXTURE_2D,oe,J,H.width,H.height,0,H.data):Ce("WebGLRenderer: Attempt to load unsupported compressed texture format in .uploadTexture()"):ae?Te&&t.texSubImage2D(i.TEXTURE_2D,oe,0,0,H.width,H.height,he,A,H.data):t.texImage2D(i.TEXTURE_2D,oe,J,H.width,H.height,0,he,A,H.data)}else if(x.isDataArrayTexture)if(ae){if(ce&&t.texStorage3D(i.TEXTURE_2D_ARRAY,Ge,J,Z.width,Z.height,Z.depth),Te)if(x.layerUpdates.size>0){let oe=Yl(Z.width,Z.height,x.format,x.type);for(let Re of x.layerUpdates){let ze=Z.data.subarray(Re*oe/Z.data.BYTES_PER_ELEMENT,(Re+1)*oe/Z.data.BYTES_PER_ELEMENT);t.texSubImage3D(i.TEXTURE_2D_ARRAY,0,0,0,Re,Z.width,Z.height,1,he,A,ze)}x.clearLayerUpdates()}else t.texSubImage3D(i.TEXTURE_2D_ARRAY,0,0,0,0,Z.width,Z.height,Z.depth,he,A,Z.data)}else t.texImage3D(i.TEXTURE_2D_ARRAY,0,J,Z.width,Z.height,Z.depth,0,he,A,Z.data);else if(x.isData3DTexture)ae?(ce&&t.texStorage3D(i.TEXTURE_3D,Ge,J,Z.width,Z.height,Z.depth),Te&&t.texSubImage3D(i.TEXTURE_3D,0,0,0,0,Z.width,Z.height,Z.depth,he,A,Z.data)):t.texImage3D(i.TEXTURE_3D,0,J,Z.width,Z.height,Z.depth,0,he,A,Z.data);else if(x.isFramebufferTexture){if(ce)if(ae)t.texStorage2D(i.TEXTURE_2D,Ge,J,Z.width,Z.height);else{let oe=Z.width,Re=Z.height;for(let ze=0;ze<Ge;ze++)t.texImage2D(i.TEXTURE_2D,ze,J,oe,Re,0,he,A,null),oe>>=1,Re>>=1}}else if(x.isHTMLTexture){if("texElementImage2D"in i){let oe=i.canvas;if(oe.hasAttribute("layoutsubtree")||oe.setAttribute("layoutsubtree","true"),Z.parentNode!==oe){oe.appendChild(Z),d.add(x),oe.onpaint=Re=>{let ze=Re.changedElements;for(let ge of d)ze.includes(ge.image)&&(ge.needsUpdate=!0)},oe.requestPaint();return}if(i.texElementImage2D.length===3)i.texElementImage2D(i.TEXTURE_2D,i.RGBA8,Z);else{let ze=i.RGBA,ge=i.RGBA,tt=i.UNSIGNED_BYTE;i.texElementImage2D(i.TEXTURE_2D,0,ze,ge,tt,Z)}i.texParameteri(i.TEXTURE_2D,i.TEXTURE_MIN_FILTER,i.LINEAR),i.texParameteri(i.TEXTURE_2D,i.TEXTURE_WRAP_S,i.CLAMP_TO_EDGE),i.texParameteri(i.TEXTURE_2D,i.TEXTURE_WRAP_T,i.CLAMP_TO_EDGE)}}else if(ue.length>0){if(ae&&ce){let oe=Oe(ue[0]);t.texStorage2D(i.TEXTURE_2D,Ge,J,oe.width,oe.height)}for(let oe=0,Re=ue.length;oe<Re;oe++)H=ue[oe],ae?Te&&t.texSubImage2D(i.TEXTURE_2D,oe,0,0,he,A,H):t.texImage2D(i.TEXTURE_2D,oe,J,he,A,H);x.generateMipmaps=!1}else if(ae){if(ce){let oe=Oe(Z);t.texStorage2D(i.TEXTURE_2D,Ge,J,oe.width,oe.height)}Te&&t.texSubImage2D(i.TEXTURE_2D,0,0,0,he,A,Z)}else t.texImage2D(i.TEXTURE_2D,0,J,he,A,Z);R(x)&&x.mipmapsAutoUpdate===!0&&w(se),fe.X=le.version,x.onUpdate&&x.onUpdate(x)}M.X=x.version}function Xt(M,x,O){if(x.image.length!==6)return;let se=nt(M,x),ee=x.source;t.bindTexture(i.TEXTURE_CUBE_MAP,M._,i.TEXTURE0+O);let le=n.get(ee);if(ee.version!==le.X||se===!0){t.activeTexture(i.TEXTURE0+O);let fe=Ye.getPrimaries(Ye.workingColorSpace),Y=x.colorSpace===$n?null:Ye.getPrimaries(x.colorSpace),Z=x.colorSpace===$n||fe===Y?i.NONE:i.BROWSER_DEFAULT_WEBGL;t.pixelStorei(i.UNPACK_FLIP_Y_WEBGL,x.flipY),t.pixelStorei(i.UNPACK_PREMULTIPLY_ALPHA_WEBGL,x.premultiplyAlpha),t.pixelStorei(i.UNPACK_ALIGNMENT,x.unpackAlignment),t.pixelStorei(i.UNPACK_COLORSPACE_CONVERSION_WEBGL,Z);let he=x.isCompressedTexture||x.image[0].isCompressedTexture,A=x.image[0]&&x.image[0].isDataTexture,J=[];for(let ge=0;ge<6;ge++)!he&&!A?J[ge]=_(x.image[ge],!0,s.maxCubemapSize):J[ge]=A?x.image[ge].image:x.image[ge],J[ge]=Le(x,J[ge]);let H=J[0],ue=r.convert(x.format,x.colorSpace),ae=r.convert(x.type),ce=E(x.internalFormat,ue,ae,x.normalized,x.colorSpace),Te=x.isVideoTexture!==!0,Ge=le.X===void 0||se===!0,oe=ee.dataReady,Re=b(x,H);et(i.TEXTURE_CUBE_MAP,x);let ze;if(x.isDepthTexture){if(ce=g(x.format===Yn,x.type),Ge)if(Te)t.texStorage2D(i.TEXTURE_CUBE_MAP,1,ce,H.width,H.height);else for(let ge=0;ge<6;ge++)t.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+ge,0,ce,H.width,H.height,0,ue,ae,null)}else if(he){Te&&Ge&&t.texStorage2D(i.TEXTURE_CUBE_MAP,Re,ce,H.width,H.height);for(let ge=0;ge<6;ge++){ze=J[ge].mipmaps;for(let tt=0;tt<ze.length;tt++){let wt=ze[tt];x.format!==bn?ue!==null?Te?oe&&t.compressedTexSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+ge,tt,0,0,wt.width,wt.height,ue,wt.data):t.compressedTexImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+ge,tt,ce,wt.width,wt.height,0,wt.data):Ce("WebGLRenderer: Attempt to load unsupported compressed texture format in .setTextureCube()"):Te?oe&&t.texSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+ge,tt,0,0,wt.width,wt.height,ue,ae,wt.data):t.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+ge,tt,ce,wt.width,wt.height,0,ue,ae,wt.data)}}}else{if(ze=x.mipmaps,Te&&Ge){ze.length>0&&Re++;let ge=Oe(J[0]);t.texStorage2D(i.TEXTURE_CUBE_MAP,Re,ce,ge.width,ge.height)}for(let ge=0;ge<6;ge++)if(A){Te?oe&&t.texSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+ge,0,0,0,J[ge].width,J[ge].height,ue,ae,J[ge].data):t.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+ge,0,ce,J[ge].width,J[ge].height,0,ue,ae,J[ge].data);for(let tt=0;tt<ze.length;tt++){let Kn=ze[tt].image[ge].image;Te?oe&&t.texSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+ge,tt+1,0,0,Kn.width,Kn.height,ue,ae,Kn.data):t.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+ge,tt+1,ce,Kn.width,Kn.height,0,ue,ae,Kn.data)}}else{Te?oe&&t.texSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+ge,0,0,0,ue,ae,J[ge]):t.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+ge,0,ce,ue,ae,J[ge]);for(let tt=0;tt<ze.length;tt++){let wt=ze[tt];Te?oe&&t.texSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+ge,tt+1,0,0,ue,ae,wt.image[ge]):t.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+ge,tt+1,ce,ue,ae,wt.image[ge])}}}R(x)&&x.mipmapsAutoUpdate===!0&&w(i.TEXTURE_CUBE_MAP),le.X=ee.version,x.onUpdate&&x.onUpdate(x)}M.X=x.version}function ct(M,x,O,se,ee,le){let fe=r.convert(O.format,O.colorSpace),Y=r.convert(O.type),Z=E(O.internalFormat,fe,Y,O.normalized,O.colorSpace),he=n.get(x),A=n.get(O);if(A.hn=x,!he.ui){let J=Math.max(1,x.width>>le),H=Math.max(1,x.height>>le);ee===i.TEXTURE_3D||ee===i.TEXTURE_2D_ARRAY?t.texImage3D(ee,le,Z,J,H,x.depth,0,fe,Y,null):t.texImage2D(ee,le,Z,J,H,0,fe,Y,null)}t.bindFramebuffer(i.FRAMEBUFFER,M),me(x)?a.framebufferTexture2DMultisampleEXT(i.FRAMEBUFFER,se,ee,A._,0,at(x)):(ee===i.TEXTURE_2D||ee>=i.TEXTURE_CUBE_MAP_POSITIVE_X&&ee<=i.TEXTURE_CUBE_MAP_NEGATIVE_Z)&&i.framebufferTexture2D(i.FRAMEBUFFER,se,ee,A._,le),t.bindFramebuffer(i.FRAMEBUFFER,null)}function _n(M,x,O){if(i.bindRenderbuffer(i.RENDERBUFFER,M),x.depthBuffer){let se=x.depthTexture,ee=se&&se.isDepthTexture?se.type:null,le=g(x.stencilBuffer,ee),fe=x.stencilBuffer?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT;me(x)?a.renderbufferStorageMultisampleEXT(i.RENDERBUFFER,at(x),le,x.width,x.height):O?i.renderbufferStorageMultisample(i.RENDERBUFFER,at(x),le,x.width,x.height):i.renderbufferStorage(i.RENDERBUFFER,le,x.width,x.height),i.framebufferRenderbuffer(i.FRAMEBUFFER,fe,i.RENDERBUFFER,M)}else{let se=x.textures;for(let ee=0;ee<se.length;ee++){let le=se[ee],fe=r.convert(le.format,le.colorSpace),Y=r.convert(le.type),Z=E(le.internalFormat,fe,Y,le.normalized,le.colorSpace);me(x)?a.renderbufferStorageMultisampleEXT(i.RENDERBUFFER,at(x),Z,x.width,x.height):O?i.renderbufferStorageMultisample(i.RENDERBUFFER,at(x),Z,x.width,x.height):i.renderbufferStorage(i.RENDERBUFFER,Z,x.width,x.height)}}i.bindRenderbuffer(i.RENDERBUFFER,null)}function _t(M,x,O){let se=x.isWebGLCubeRenderTarget===!0;if(t.bindFramebuffer(i.FRAMEBUFFER,M),!(x.depthTexture&&x.depthTexture.isDepthTexture))throw new Error("THREE.WebGLTextures: renderTarget.depthTexture must be an instance of THREE.DepthTexture.");let ee=n.get(x.depthTexture);ee.hn=x;let le=se?x.depthTexture.image[0]:x.depthTexture.image;(!ee._||le.width!==x.width||le.height!==x.height)&&(le.width=x.width,le.height=x.height,x.depthTexture.needsUpdate=!0),se?ye(x.depthTexture,0):xe(x.depthTexture,0);let fe=ee._,Y=at(x),Z=se?i.TEXTURE_CUBE_MAP_POSITIVE_X+O:i.TEXTURE_2D,he=x.depthTexture.format===Yn?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT;if(x.depthTexture.format===Vn)me(x)?a.framebufferTexture2DMultisampleEXT(i.FRAMEBUFFER,he,Z,fe,0,Y):i.framebufferTexture2D(i.FRAMEBUFFER,he,Z,fe,0);else if(x.depthTexture.format===Yn)me(x)?a.framebufferTexture2DMultisampleEXT(i.FRAMEBUFFER,he,Z,fe,0,Y):i.framebufferTexture2D(i.FRAMEBUFFER,he,Z,fe,0);else throw new Error("THREE.WebGLTextures: Unknown depthTexture format.")}function rn(M){let x=n.get(M),O=M.isWebGLCubeRenderTarget===!0;if(x.un!==M.depthTexture){let se=M.depthTexture;if(x.pt&&x.pt(),se){let ee=()=>{delete x.un,delete x.pt,se.removeEventListener("dispose",ee)};se.addEventListener("dispose",ee),x.pt=ee}x.un=se}if(M.depthTexture&&!x.dn)if(O)for(let se=0;se<6;se++)_t(x.M[se],M,se);else M.texture.mipmaps.length>0?_t(x.M[0],M,0):_t(x.M,M,0);else if(O){x.Z=[];for(let se=0;se<6;se++)if(t.bindFramebuffer(i.FRAMEBUFFER,x.M[se]),x.Z[se]===void 0)x.Z[se]=i.createRenderbuffer(),_n(x.Z[se],M,!1);else{let ee=M.stencilBuffer?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT,le=x.Z[se];i.bindRenderbuffer(i.RENDERBUFFER,le),i.framebufferRenderbuffer(i.FRAMEBUFFER,ee,i.RENDERBUFFER,le)}}else if(M.texture.mipmaps.length>0?t.bindFramebuffer(i.FRAMEBUFFER,x.M[0]):t.bindFramebuffer(i.FRAMEBUFFER,x.M),x.Z===void 0)x.Z=i.createRenderbuffer(),_n(x.Z,M,!1);else{let ee=M.stencilBuffer?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT,le=x.Z;i.bindRenderbuffer(i.RENDERBUFFER,le),i.framebufferRenderbuffer(i.FRAMEBUFFER,ee,i.RENDERBUFFER,le)}t.bindFramebuffer(i.FRAMEBUFFER,null)}function on(M,x,O){let se=n.get(M);x!==void 0&&ct(se.M,M,M.texture,i.COLOR_ATTACHMENT0,i.TEXTURE_2D,0),O!==void 0&&rn(M)}function an(M){let x=M.texture,O=n.get(M),se=n.get(x);M.addEventListener("dispose",G),k(M);let ee=M.textures,le=M.isWebGLCubeRenderTarget===!0,fe=ee.length>1;if(fe||(se._===void 0&&(se._=i.createTexture()),se.X=x.version,o.memory.textures++),le){O.M=[];for(let Y=0;Y<6;Y++)if(x.mipmaps.length>0){O.M[Y]=[];for(let Z=0;Z<x.mipmaps.length;Z++)O.M[Y][Z]=i.createFramebuffer()}else O.M[Y]=i.createFramebuffer()}else{if(x.mipmaps.length>0){O.M=[];for(let Y=0;Y<x.mipmaps.length;Y++)O.M[Y]=i.createFramebuffer()}else O.M=i.createFramebuffer();if(fe)for(let Y=0,Z=ee.length;Y<Z;Y++){let he=n.get(ee[Y]);he._===void 0&&(he._=i.createTexture(),o.memory.textures++)}if(M.samples>0&&me(M)===!1){O.ve=i.createFramebuffer(),O.re=[],t.bindFramebuffer(i.FRAMEBUFFER,O.ve);for(let Y=0;Y<ee.length;Y++){let Z=ee[Y];O.re[Y]=i.createRenderbuffer(),i.bindRenderbuffer(i.RENDERBUFFER,O.re[Y]);let he=r.convert(Z.format,Z.colorSpace),A=r.convert(Z.type),J=E(Z.internalFormat,he,A,Z.normalized,Z.colorSpace,M.isXRRenderTarget===!0),H=at(M);i.renderbufferStorageMultisample(i.RENDERBUFFER,H,J,M.width,M.height),i.framebufferRenderbuffer(i.FRAMEBUFFER,i.COLOR_ATTACHMENT0+Y,i.RENDERBUFFER,O.re[Y])}i.bindRenderbuffer(i.RENDERBUFFER,null),M.depthBuffer&&(O.cn=i.createRenderbuffer(),_n(O.cn,M,!0)),t.bindFramebuffer(i.FRAMEBUFFER,null)}}if(le){t.bindTexture(i.TEXTURE_CUBE_MAP,se._),et(i.TEXTURE_CUBE_MAP,x);for(let Y=0;Y<6;Y++)if(x.mipmaps.length>0)for(let Z=0;Z<x.mipmaps.length;Z++)ct(O.M[Y][Z],M,x,i.COLOR_ATTACHMENT0,i.TEXTURE_CUBE_MAP_POSITIVE_X+Y,Z);else ct(O.M[Y],M,x,i.COLOR_ATTACHMENT0,i.TEXTURE_CUBE_MAP_POSITIVE_X+Y,0);R(x)?w(i.TEXTURE_CUBE_MAP):x.mipmaps.length>0&&i.texParameteri(i.TEXTURE_CUBE_MAP,i.TEXTURE_MAX_LEVEL,x.mipmaps.length-1),t.unbindTexture()}else if(fe){for(let Y=0,Z=ee.length;Y<Z;Y++){let he=ee[Y],A=n.get(he),J=i.TEXTURE_2D;(M.isWebGL3DRenderTarget||M.isWebGLArrayRenderTarget)&&(J=M.isWebGL3DRenderTarget?i.TEXTURE_3D:i.TEXTURE_2D_ARRAY),t.bindTexture(J,A._),et(J,he),ct(O.M,M,he,i.COLOR_ATTACHMENT0+Y,J,0),R(he)&&w(J)}t.unbindTexture()}else{let Y=i.TEXTURE_2D;if((M.isWebGL3DRenderTarget||M.isWebGLArrayRenderTarget)&&(Y=M.isWebGL3DRenderTarget?i.TEXTURE_3D:i.TEXTURE_2D_ARRAY),t.bindTexture(Y,se._),et(Y,x),x.mipmaps.length>0)for(let Z=0;Z<x.mipmaps.length;Z++)ct(O.M[Z],M,x,i.COLOR_ATTACHMENT0,Y,Z);else ct(O.M,M,x,i.COLOR_ATTACHMENT0,Y,0);R(x)?w(Y):x.mipmaps.length>0&&i.texParameteri(Y,i.TEXTURE_MAX_LEVEL,x.mipmaps.length-1),t.unbindTexture()}M.depthBuffer&&rn(M)}function I(M){let x=M.textures;for(let O=0,se=x.length;O<se;O++){let ee=x[O];if(R(ee)&&ee.mipmapsAutoUpdate===!0){let le=T(M),fe=n.get(ee)._;t.bindTexture(le,fe),w(le),t.unbindTexture()}}}let ln=[];function ot(M){if(M.samples>0){if(me(M)===!1){let x=M.textures,O=M.width,se=M.height,ee=i.COLOR_BUFFER_BIT,le=M.stencilBuffer?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT,fe=n.get(M),Y=x.length>1;if(Y)for(let he=0;he<x.length;he++)t.bindFramebuffer(i.FRAMEBUFFER,fe.ve),i.framebufferRenderbuffer(i.FRAMEBUFFER,i.COLOR_ATTACHMENT0+he,i.RENDERBUFFER,null),t.bindFramebuffer(i.FRAMEBUFFER,fe.M),i.framebufferTexture2D(i.DRAW_FRAMEBUFFER,i.COLOR_ATTACHMENT0+he,i.TEXTURE_2D,null,0);t.bindFramebuffer(i.READ_FRAMEBUFFER,fe.ve),M.texture.mipmaps.length>0?t.bindFramebuffer(i.DRAW_FRAMEBUFFER,fe.M[0]):t.bindFramebuffer(i.DRAW_FRAMEBUFFER,fe.M);for(let he=0;he<x.length;he++){if(M.resolveDepthBuffer&&(M.depthBuffer&&(ee|=i.DEPTH_BUFFER_BIT),M.stencilBuffer&&M.resolveStencilBuffer&&(ee|=i.STENCIL_BUFFER_BIT)),Y){i.framebufferRenderbuffer(i.READ_FRAMEBUFFER,i.COLOR_ATTACHMENT0,i.RENDERBUFFER,fe.re[he]);let A=n.get(x[he])._;i.framebufferTexture2D(i.DRAW_FRAMEBUFFER,i.COLOR_ATTACHMENT0,i.TEXTURE_2D,A,0)}i.blitFramebuffer(0,0,O,se,0,0,O,se,ee,i.NEAREST),l===!0&&(ln.length=0,ln.push(i.COLOR_ATTACHMENT0+he),M.depthBuffer&&M.storeMultisampledDepthBuffer===!1&&ln.push(le),i.invalidateFramebuffer(i.READ_FRAMEBUFFER,ln))}if(t.bindFramebuffer(i.READ_FRAMEBUFFER,null),t.bindFramebuffer(i.DRAW_FRAMEBUFFER,null),Y)for(let he=0;he<x.length;he++){t.bindFramebuffer(i.FRAMEBUFFER,fe.ve),i.framebufferRenderbuffer(i.FRAMEBUFFER,i.COLOR_ATTACHMENT0+he,i.RENDERBUFFER,fe.re[he]);let A=n.get(x[he])._;t.bindFramebuffer(i.FRAMEBUFFER,fe.M),i.framebufferTexture2D(i.DRAW_FRAMEBUFFER,i.COLOR_ATTACHMENT0+he,i.TEXTURE_2D,A,0)}t.bindFramebuffer(i.DRAW_FRAMEBUFFER,fe.ve)}else if(M.depthBuffer&&M.storeMultisampledDepthBuffer===!1&&l){let x=M.stencilBuffer?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT;i.invalidateFramebuffer(i.DRAW_FRAMEBUFFER,[x])}}}function at(M){return Math.min(s.maxSamples,M.samples)}function me(M){let x=n.get(M);return M.samples>0&&e.has("WEBGL_multisampled_render_to_texture")===!0&&x.Ds!==!1}function xt(M){let x=o.render.frame;h.get(M)!==x&&(h.set(M,x),M.update())}function Le(M,x){let O=M.colorSpace,se=M.format,ee=M.type;return M.isCompressedTexture===!0||M.isVideoTexture===!0||O!==Ls&&O!==$n&&(Ye.getTransfer(O)===Qe?(se!==bn||ee!==sn)&&Ce("WebGLTextures: sRGB encoded textures have to use RGBAFormat and UnsignedByteType."):Ne("WebGLTextures: Unsupported texture color space:",O)),x}function Oe(M){return typeof HTMLImageElement<"u"&&M instanceof HTMLImageElement?(c.width=M.naturalWidth||M.width,c.height=M.naturalHeight||M.height):typeof VideoFrame<"u"&&M instanceof VideoFrame?(c.width=M.displayWidth,c.height=M.displayHeight):(c.width=M.width,c.height=M.height),c}this.allocateTextureUnit=Fe,this.resetTextureUnits=te,this.getTextureUnits=ie,this.setTextureUnits=Ee,this.setTexture2D=xe,this.setTexture2DArray=be,this.setTexture3D=Pe,this.setTextureCube=ye,this.rebindTextures=on,this.setupRenderTarget=an,this.updateRenderTargetMipmap=I,this.updateMultisampleRenderTarget=ot,this.setupDepthRenderbuffer=rn,this.setupFrameBufferTexture=ct,this.useMultisampledRTT=me,this.dispose=q}function Bv(i,e){function t(n,s=$n){let r,o=Ye.getTransfer(s);if(n===sn)return i.UNSIGNED_BYTE;if(n===Lo)return i.UNSIGNED_SHORT_4_4_4_4;if(n===Io)return i.UNSIGNED_SHORT_5_5_5_1;if(n===Pl)return i.UNSIGNED_INT_5_9_9_9_REV;if(n===Ll)return i.UNSIGNED_INT_10F_11F_11F_REV;if(n===Rl)return i.BYTE;if(n===Cl)return i.SHORT;if(n===ds)return i.UNSIGNED_SHORT;if(n===Po)return i.INT;if(n===yn)return i.UNSIGNED_INT;if(n===Sn)return i.FLOAT;if(n===Mn)return i.HALF_FLOAT;if(n===Il)return i.ALPHA;if(n===Nl)return i.RGB;if(n===bn)return i.RGBA;if(n===Vn)return i.DEPTH_COMPONENT;if(n===Yn)return i.DEPTH_STENCIL;if(n===Dl)return i.RED;if(n===No)return i.RED_INTEGER;if(n===xi)return i.RG;if(n===Do)return i.RG_INTEGER;if(n===Uo)return i.RGBA_INTEGER;if(n===Js||n===Ks||n===Qs||n===er)if(o===Qe)if(r=e.get("WEBGL_compressed_texture_s3tc_srgb"),r!==null){if(n===Js)return r.COMPRESSED_SRGB_S3TC_DXT1_EXT;if(n===Ks)return r.COMPRESSED_SRGB_ALPHA_S3TC_DXT1_EXT;if(n===Qs)return r.COMPRESSED_SRGB_ALPHA_S3TC_DXT3_EXT;if(n===er)return r.COMPRESSED_SRGB_ALPHA_S3TC_DXT5_EXT}else return null;else if(r=e.get("WEBGL_compressed_texture_s3tc"),r!==null){if(n===Js)return r.COMPRESSED_RGB_S3TC_DXT1_EXT;if(n===Ks)return r.COMPRESSED_RGBA_S3TC_DXT1_EXT;if(n===Qs)return r.COMPRESSED_RGBA_S3TC_DXT3_EXT;if(n===er)return r.COMPRESSED_RGBA_S3TC_DXT5_EXT}else return null;if(n===Oo||n===Fo||n===Bo||n===ko)if(r=e.get("WEBGL_compressed_texture_pvrtc"),r!==null){if(n===Oo)return r.COMPRESSED_RGB_PVRTC_4BPPV1_IMG;if(n===Fo)return r.COMPRESSED_RGB_PVRTC_2BPPV1_IMG;if(n===Bo)return r.COMPRESSED_RGBA_PVRTC_4BPPV1_IMG;if(n===ko)return r.COMPRESSED_RGBA_PVRTC_2BPPV1_IMG}else return null;if(n===zo||n===Go||n===Vo||n===Ho||n===Wo||n===tr||n===Xo)if(r=e.get("WEBGL_compressed_texture_etc"),r!==null){if(n===zo||n===Go)return o===Qe?r.COMPRESSED_SRGB8_ETC2:r.COMPRESSED_RGB8_ETC2;if(n===Vo)return o===Qe?r.COMPRESSED_SRGB8_ALPHA8_ETC2_EAC:r.COMPRESSED_RGBA8_ETC2_EAC;if(n===Ho)return r.COMPRESSED_R11_EAC;if(n===Wo)return r.COMPRESSED_SIGNED_R11_EAC;if(n===tr)return r.COMPRESSED_RG11_EAC;if(n===Xo)return r.COMPRESSED_SIGNED_RG11_EAC}else return null;if(n===qo||n===Yo||n===$o||n===Zo||n===jo||n===Jo||n===Ko||n===Qo||n===ea||n===ta||n===na||n===ia||n===sa||n===ra)if(r=e.get("WEBGL_compressed_texture_astc"),r!==null){if(n===qo)return o===Qe?r.COMPRESSED_SRGB8_ALPHA8_ASTC_4x4_KHR:r.COMPRESSED_RGBA_ASTC_4x4_KHR;if(n===Yo)return o===Qe?r.COMPRESSED_SRGB8_ALPHA8_ASTC_5x4_KHR:r.COMPRESSED_RGBA_ASTC_5x4_KHR;if(n===$o)return o===Qe?r.COMPRESSED_SRGB8_ALPHA8_ASTC_5x5_KHR:r.COMPRESSED_RGBA_ASTC_5x5_KHR;if(n===Zo)return o===Qe?r.COMPRESSED_SRGB8_ALPHA8_ASTC_6x5_KHR:r.COMPRESSED_RGBA_ASTC_6x5_KHR;if(n===jo)return o===Qe?r.COMPRESSED_SRGB8_ALPHA8_ASTC_6x6_KHR:r.COMPRESSED_RGBA_ASTC_6x6_KHR;if(n===Jo)return o===Qe?r.COMPRESSED_SRGB8_ALPHA8_ASTC_8x5_KHR:r.COMPRESSED_RGBA_ASTC_8x5_KHR;if(n===Ko)return o===Qe?r.COMPRESSED_SRGB8_ALPHA8_ASTC_8x6_KHR:r.COMPRESSED_RGBA_ASTC_8x6_KHR;if(n===Qo)return o===Qe?r.COMPRESSED_SRGB8_ALPHA8_ASTC_8x8_KHR:r.COMPRESSED_RGBA_ASTC_8x8_KHR;if(n===ea)return o===Qe?r.COMPRESSED_SRGB8_ALPHA8_ASTC_10x5_KHR:r.COMPRESSED_RGBA_ASTC_10x5_KHR;if(n===ta)return o===Qe?r.COMPRESSED_SRGB8_ALPHA8_ASTC_10x6_KHR:r.COMPRESSED_RGBA_ASTC_10x6_KHR;if(n===na)return o===Qe?r.COMPRESSED_SRGB8_ALPHA8_ASTC_10x8_KHR:r.COMPRESSED_RGBA_ASTC_10x8_KHR;if(n===ia)return o===Qe?r.COMPRESSED_SRGB8_ALPHA8_ASTC_10x10_KHR:r.COMPRESSED_RGBA_ASTC_10x10_KHR;if(n===sa)return o===Qe?r.COMPRESSED_SRGB8_ALPHA8_ASTC_12x10_KHR:r.COMPRESSED_RGBA_ASTC_12x10_KHR;if(n===ra)return o===Qe?r.COMPRESSED_SRGB8_ALPHA8_ASTC_12x12_KHR:r.COMPRESSED_RGBA_ASTC_12x12_KHR}else return null;if(n===oa||n===aa||n===la)if(r=e.get("EXT_texture_compression_bptc"),r!==null){if(n===oa)return o===Qe?r.COMPRESSED_SRGB_ALPHA_BPTC_UNORM_EXT:r.COMPRESSED_RGBA_BPTC_UNORM_EXT;if(n===aa)return r.COMPRESSED_RGB_BPTC_SIGNED_FLOAT_EXT;if(n===la)return r.COMPRESSED_RGB_BPTC_UNSIGNED_FLOAT_EXT}else return null;if(n===ca||n===ha||n===nr||n===ua)if(r=e.get("EXT_texture_compression_rgtc"),r!==null){if(n===ca)return r.COMPRESSED_RED_RGTC1_EXT;if(n===ha)return r.COMPRESSED_SIGNED_RED_RGTC1_EXT;if(n===nr)return r.COMPRESSED_RED_GREEN_RGTC2_EXT;if(n===ua)return r.COMPRESSED_SIGNED_RED_GREEN_RGTC2_EXT}else return null;return n===Ni?i.UNSIGNED_INT_24_8:i[n]!==void 0?i[n]:null}return{convert:t}}var kv=`
void main() {

gl_Position = vec4( position, 1.0 );

}`,zv=`
uniform sampler2DArray depthColor;
uniform float depthWidth;
uniform float depthHeight;

void main() {

vec2 coord = vec2( gl_FragCoord.x / depthWidth, gl_FragCoord.y / depthHeight );

if ( coord.x >= 1.0 ) {

gl_FragDepth = texture( depthColor, vec3( coord.x - 1.0, coord.y, 1 ) ).r;

} else {

gl_FragDepth = texture( depthColor, vec3( coord.x, coord.y, 0 ) ).r;

}

}`,nc=class{constructor(){this.texture=null,this.mesh=null,this.depthNear=0,this.depthFar=0}init(e,t){if(this.texture===null){let n=new Ws(e.texture);(e.depthNear!==t.depthNear||e.depthFar!==t.depthFar)&&(this.depthNear=e.depthNear,this.depthFar=e.depthFar),this.texture=n}}getMesh(e){if(this.texture!==null&&this.mesh===null){let t=e.cameras[0].viewport,n=new Tn({vertexShader:kv,fragmentShader:zv,uniforms:{depthColor:{value:this.texture},depthWidth:{value:t.z},depthHeight:{value:t.w}}});this.mesh=new Ht(new Xs(20,20),n)}return this.mesh}reset(){this.texture=null,this.mesh=null}getDepthTexture(){return this.texture}},ic=class extends xn{constructor(e,t){super();let n=this,s=null,r=1,o=null,a="local-floor",l=1,c=null,h=null,d=null,u=null,f=null,v=null,S=typeof XRWebGLBinding<"u",m=new nc,p={},_=t.getContextAttributes(),R=null,w=null,T=[],E=[],g=new De,b=null,k=null,L=new Gt;L.viewport=new dt;let D=new Gt;D.viewport=new dt;let G=[L,D],$=new Ao,P=null,q=null;this.cameraAutoUpdate=!0,this.enabled=!1,this.isPresenting=!1,this.getController=function(j){let xe=T[j];return xe===void 0&&(xe=new ss,T[j]=xe),xe.getTargetRaySpace()},this.getControllerGrip=function(j){let xe=T[j];return xe===void 0&&(xe=new ss,T[j]=xe),xe.getGripSpace()},this.getHand=function(j){let xe=T[j];return xe===void 0&&(xe=new ss,T[j]=xe),xe.getHandSpace()};function K(j){let xe=E.indexOf(j.inputSource);if(xe===-1)return;let be=T[xe];be!==void 0&&(be.update(j.inputSource,j.frame,c||o),be.dispatchEvent({type:j.type,data:j.inputSource}))}function V(){s.removeEventListener("select",K),s.removeEventListener("selectstart",K),s.removeEventListener("selectend",K),s.removeEventListener("squeeze",K),s.removeEventListener("squeezestart",K),s.removeEventListener("squeezeend",K),s.removeEventListener("end",V),s.removeEventListener("inputsourceschange",re);for(let j=0;j<T.length;j++){let xe=E[j];xe!==null&&(E[j]=null,T[j].disconnect(xe))}P=null,q=null,m.reset();for(let j in p)delete p[j];if(e.setRenderTarget(R),f=null,u=null,d=null,s=null,w=null,Fe.stop(),n.isPresenting=!1,e.setPixelRatio(b),e.setSize(g.width,g.height,!1),k!==null){let j=k.camera;j.fov=k.fov,j.zoom=k.zoom,j.updateProjectionMatrix(),k=null}n.dispatchEvent({type:"sessionend"})}this.setFramebufferScaleFactor=function(j){r=j,n.isPresenting===!0&&Ce("WebXRManager: Cannot change framebuffer scale while presenting.")},this.setReferenceSpaceType=function(j){a=j,n.isPresenting===!0&&Ce("WebXRManager: Cannot change reference space type while presenting.")},this.getReferenceSpace=function(){return c||o},this.setReferenceSpace=function(j){c=j},this.getBaseLayer=function(){return u!==null?u:f},this.getBinding=function(){return d===null&&S&&(d=new XRWebGLBinding(s,t)),d},this.getFrame=function(){return v},this.getSession=function(){return s},this.setSession=async function(j){if(s=j,s!==null){if(R=e.getRenderTarget(),s.addEventListener("select",K),s.addEventListener("selectstart",K),s.addEventListener("selectend",K),s.addEventListener("squeeze",K),s.addEventListener("squeezestart",K),s.addEventListener("squeezeend",K),s.addEventListener("end",V),s.addEventListener("inputsourceschange",re),_.xrCompatible!==!0&&await t.makeXRCompatible(),b=e.getPixelRatio(),e.getSize(g),S&&"createProjectionLayer"in XRWebGLBinding.prototype){let be=null,Pe=null,ye=null;_.depth&&(ye=_.stencil?t.DEPTH24_STENCIL8:t.DEPTH_COMPONENT24,be=_.stencil?Yn:Vn,Pe=_.stencil?Ni:yn);let ke={colorFormat:t.RGBA8,depthFormat:ye,scaleFactor:r};d=this.getBinding(),u=d.createProjectionLayer(ke),s.updateRenderState({layers:[u]}),e.setPixelRatio(1),e.setSize(u.textureWidth,u.textureHeight,!1),w=new tn(u.textureWidth,u.textureHeight,{format:bn,type:sn,depthTexture:new Xn(u.textureWidth,u.textureHeight,Pe,void 0,void 0,void 0,void 0,void 0,void 0,be),stencilBuffer:_.stencil,colorSpace:e.outputColorSpace,samples:_.antialias?4:0,resolveDepthBuffer:u.ignoreDepthValues===!1,resolveStencilBuffer:u.ignoreDepthValues===!1,storeMultisampledDepthBuffer:u.ignoreDepthValues===!1,storeMultisampledStencilBuffer:u.ignoreDepthValues===!1})}else{let be={antialias:_.antialias,alpha:!0,depth:_.depth,stencil:_.stencil,framebufferScaleFactor:r};f=new XRWebGLLayer(s,t,be),s.updateRenderState({baseLayer:f}),e.setPixelRatio(1),e.setSize(f.framebufferWidth,f.framebufferHeight,!1),w=new tn(f.framebufferWidth,f.framebufferHeight,{format:bn,type:sn,colorSpace:e.outputColorSpace,stencilBuffer:_.stencil,resolveDepthBuffer:f.ignoreDepthValues===!1,resolveStencilBuffer:f.ignoreDepthValues===!1,storeMultisampledDepthBuffer:f.ignoreDepthValues===!1,storeMultisampledStencilBuffer:f.ignoreDepthValues===!1})}w.isXRRenderTarget=!0,this.setFoveation(l),c=null,o=await s.requestReferenceSpace(a),Fe.setContext(s),Fe.start(),n.isPresenting=!0,n.dispatchEvent({type:"sessionstart"})}},this.getEnvironmentBlendMode=function(){if(s!==null)return s.environmentBlendMode},this.getDepthTexture=function(){return m.getDepthTexture()};function re(j){for(let xe=0;xe<j.removed.length;xe++){let be=j.removed[xe],Pe=E.indexOf(be);Pe>=0&&(E[Pe]=null,T[Pe].disconnect(be))}for(let xe=0;xe<j.added.length;xe++){let be=j.added[xe],Pe=E.indexOf(be);if(Pe===-1){for(let ke=0;ke<T.length;ke++)if(ke>=E.length){E.push(be),Pe=ke;break}else if(E[ke]===null){E[ke]=be,Pe=ke;break}if(Pe===-1)break}let ye=T[Pe];ye&&ye.connect(be)}}function X(j,xe){xe===null?j.matrixWorld.copy(j.matrix):j.matrixWorld.multiplyMatrices(xe.matrixWorld,j.matrix),j.matrixWorldInverse.copy(j.matrixWorld).invert()}this.updateCamera=function(j){if(s===null)return;let xe=j.near,be=j.far;m.texture!==null&&(m.depthNear>0&&(xe=m.depthNear),m.depthFar>0&&(be=m.depthFar)),$.near=D.near=L.near=xe,$.far=D.far=L.far=be,(P!==$.near||q!==$.far)&&(s.updateRenderState({depthNear:$.near,depthFar:$.far}),P=$.near,q=$.far),$.layers.mask=j.layers.mask|6,L.layers.mask=$.layers.mask&-5,D.layers.mask=$.layers.mask&-3;let Pe=j.parent,ye=$.cameras;X($,Pe);for(let ke=0;ke<ye.length;ke++)X(ye[ke],Pe);$.projectionMatrix.copy(L.projectionMatrix),$.projectionMatrixInverse.copy(L.projectionMatrixInverse),k===null&&j.isPerspectiveCamera&&(k={camera:j,fov:j.fov,zoom:j.zoom}),te(j,$,Pe)};function te(j,xe,be){be===null?j.matrix.copy(xe.matrixWorld):(j.matrix.copy(be.matrixWorld),j.matrix.invert(),j.matrix.multiply(xe.matrixWorld)),j.matrix.decompose(j.position,j.quaternion,j.scale),j.updateMatrixWorld(!0),j.projectionMatrix.copy(xe.projectionMatrix),j.projectionMatrixInverse.copy(xe.projectionMatrixInverse),j.isPerspectiveCamera&&(j.fov=ns*2*Math.atan(1/j.projectionMatrix.elements[5]),j.zoom=1)}this.getCamera=function(){return $},this.getFoveation=function(){if(!(u===null&&f===null))return l},this.setFoveation=function(j){l=j,u!==null&&(u.fixedFoveation=j),f!==null&&f.fixedFoveation!==void 0&&(f.fixedFoveation=j)},this.hasDepthSensing=function(){return m.texture!==null},this.getDepthSensingMesh=function(){return m.getMesh($)},this.getCameraTexture=function(j){return p[j]};let ie=null;function Ee(j,xe){if(h=xe.getViewerPose(c||o),v=xe,h!==null){let be=h.views;f!==null&&(e.setRenderTargetFramebuffer(w,f.framebuffer),e.setRenderTarget(w));let Pe=!1;be.length!==$.cameras.length&&($.cameras.length=0,Pe=!0);for(let Ie=0;Ie<be.length;Ie++){let et=be[Ie],nt=null;if(f!==null)nt=f.getViewport(et);else{let Ct=d.getViewSubImage(u,et);nt=Ct.viewport,Ie===0&&(e.setRenderTargetTextures(w,Ct.colorTexture,Ct.depthStencilTexture),e.setRenderTarget(w))}let We=G[Ie];We===void 0&&(We=new Gt,We.layers.enable(Ie),We.viewport=new dt,G[Ie]=We),We.matrix.fromArray(et.transform.matrix),We.matrix.decompose(We.position,We.quaternion,We.scale),We.projectionMatrix.fromArray(et.projectionMatrix),We.projectionMatrixInverse.copy(We.projectionMatrix).invert(),We.viewport.set(nt.x,nt.y,nt.width,nt.height),Ie===0&&($.matrix.copy(We.matrix),$.matrix.decompose($.position,$.quaternion,$.scale)),Pe===!0&&$.cameras.push(We)}let ye=s.enabledFeatures;if(ye&&ye.includes("depth-sensing")&&s.depthUsage=="gpu-optimized"&&S){d=n.getBinding();let Ie=d.getDepthInformation(be[0]);Ie&&Ie.isValid&&Ie.texture&&m.init(Ie,s.renderState)}if(ye&&ye.includes("camera-access")&&S){e.state.unbindTexture(),d=n.getBinding();for(let Ie=0;Ie<be.length;Ie++){let et=be[Ie].camera;if(et){let nt=p[et];nt||(nt=new Ws,p[et]=nt);let We=d.getCameraImage(et);nt.sourceTexture=We}}}}for(let be=0;be<T.length;be++){let Pe=E[be],ye=T[be];Pe!==null&&ye!==void 0&&ye.update(Pe,xe,c||o)}ie&&ie(j,xe),xe.detectedPlanes&&n.dispatchEvent({type:"planesdetected",data:xe}),v=null}let Fe=new Du;Fe.setAnimationLoop(Ee),this.setAnimationLoop=function(j){ie=j},this.dispose=function(){}}},Gv=new lt,Wu=new Ue;Wu.set(-1,0,0,0,1,0,0,0,1);function Vv(i,e){function t(m,p){m.matrixAutoUpdate===!0&&m.updateMatrix(),p.value.copy(m.matrix)}function n(m,p){p.color.getRGB(m.fogColor.value,Wl(i)),p.isFog?(m.fogNear.value=p.near,m.fogFar.value=p.far):p.isFogExp2&&(m.fogDensity.value=p.density)}function s(m,p,_,R,w){p.isNodeMaterial?p.uniformsNeedUpdate=!1:p.isMeshBasicMaterial?r(m,p):p.isMeshLambertMaterial?(r(m,p),p.envMap&&(m.envMapIntensity.value=p.envMapIntensity)):p.isMeshToonMaterial?(r(m,p),d(m,p)):p.isMeshPhongMaterial?(r(m,p),h(m,p),p.envMap&&(m.envMapIntensity.value=p.envMapIntensity)):p.isMeshStandardMaterial?(r(m,p),u(m,p),p.isMeshPhysicalMaterial&&f(m,p,w)):p.isMeshMatcapMaterial?(r(m,p),v(m,p)):p.isMeshDepthMaterial?r(m,p):p.isMeshDistanceMaterial?(r(m,p),S(m,p)):p.isMeshNormalMaterial?r(m,p):p.isLineBasicMaterial?(o(m,p),p.isLineDashedMaterial&&a(m,p)):p.isPointsMaterial?l(m,p,_,R):p.isSpriteMaterial?c(m,p):p.isShadowMaterial?(m.color.value.copy(p.color),m.opacity.value=p.opacity):p.isShaderMaterial&&(p.uniformsNeedUpdate=!1)}function r(m,p){m.opacity.value=p.opacity,p.color&&m.diffuse.value.copy(p.color),p.emissive&&m.emissive.value.copy(p.emissive).multiplyScalar(p.emissiveIntensity),p.map&&(m.map.value=p.map,t(p.map,m.mapTransform)),p.alphaMap&&(m.alphaMap.value=p.alphaMap,t(p.alphaMap,m.alphaMapTransform)),p.bumpMap&&(m.bumpMap.value=p.bumpMap,t(p.bumpMap,m.bumpMapTransform),m.bumpScale.value=p.bumpScale,p.side===Nt&&(m.bumpScale.value*=-1)),p.normalMap&&(m.normalMap.value=p.normalMap,t(p.normalMap,m.normalMapTransform),m.normalScale.value.copy(p.normalScale),p.side===Nt&&m.normalScale.value.negate()),p.displacementMap&&(m.displacementMap.value=p.displacementMap,t(p.displacementMap,m.displacementMapTransform),m.displacementScale.value=p.displacementScale,m.displacementBias.value=p.displacementBias),p.emissiveMap&&(m.emissiveMap.value=p.emissiveMap,t(p.emissiveMap,m.emissiveMapTransform)),p.specularMap&&(m.specularMap.value=p.specularMap,t(p.specularMap,m.specularMapTransform)),p.alphaTest>0&&(m.alphaTest.value=p.alphaTest);let _=e.get(p),R=_.envMap,w=_.envMapRotation;R&&(m.envMap.value=R,m.envMapRotation.value.setFromMatrix4(Gv.makeRotationFromEuler(w)).transpose(),R.isCubeTexture&&R.isRenderTargetTexture===!1&&m.envMapRotation.value.premultiply(Wu),m.reflectivity.value=p.reflectivity,m.ior.value=p.ior,m.refractionRatio.value=p.refractionRatio),p.lightMap&&(m.lightMap.value=p.lightMap,m.lightMapIntensity.value=p.lightMapIntensity,t(p.lightMap,m.lightMapTransform)),p.aoMap&&(m.aoMap.value=p.aoMap,m.aoMapIntensity.value=p.aoMapIntensity,t(p.aoMap,m.aoMapTransform))}function o(m,p){m.diffuse.value.copy(p.color),m.opacity.value=p.opacity,p.map&&(m.map.value=p.map,t(p.map,m.mapTransform))}function a(m,p){m.dashSize.value=p.dashSize,m.totalSize.value=p.dashSize+p.gapSize,m.scale.value=p.scale}function l(m,p,_,R){m.diffuse.value.copy(p.color),m.opacity.value=p.opacity,m.size.value=p.size*_,m.scale.value=R*.5,p.map&&(m.map.value=p.map,t(p.map,m.uvTransform)),p.alphaMap&&(m.alphaMap.value=p.alphaMap,t(p.alphaMap,m.alphaMapTransform)),p.alphaTest>0&&(m.alphaTest.value=p.alphaTest)}function c(m,p){m.diffuse.value.copy(p.color),m.opacity.value=p.opacity,m.rotation.value=p.rotation,p.map&&(m.map.value=p.map,t(p.map,m.mapTransform)),p.alphaMap&&(m.alphaMap.value=p.alphaMap,t(p.alphaMap,m.alphaMapTransform)),p.alphaTest>0&&(m.alphaTest.value=p.alphaTest)}function h(m,p){m.specular.value.copy(p.specular),m.shininess.value=Math.max(p.shininess,1e-4)}function d(m,p){p.gradientMap&&(m.gradientMap.value=p.gradientMap)}function u(m,p){m.metalness.value=p.metalness,p.metalnessMap&&(m.metalnessMap.value=p.metalnessMap,t(p.metalnessMap,m.metalnessMapTransform)),m.roughness.value=p.roughness,p.roughnessMap&&(m.roughnessMap.value=p.roughnessMap,t(p.roughnessMap,m.roughnessMapTransform)),p.envMap&&(m.envMapIntensity.value=p.envMapIntensity)}function f(m,p,_){m.ior.value=p.ior,p.diffuseRoughness>0&&(m.diffuseRoughness.value=p.diffuseRoughness,p.diffuseRoughnessMap&&(m.diffuseRoughnessMap.value=p.diffuseRoughnessMap,t(p.diffuseRoughnessMap,m.diffuseRoughnessMapTransform))),p.sheen>0&&(m.sheenColor.value.copy(p.sheenColor).multiplyScalar(p.sheen),m.sheenRoughness.value=p.sheenRoughness,p.sheenColorMap&&(m.sheenColorMap.value=p.sheenColorMap,t(p.sheenColorMap,m.sheenColorMapTransform)),p.sheenRoughnessMap&&(m.sheenRoughnessMap.value=p.sheenRoughnessMap,t(p.sheenRoughnessMap,m.sheenRoughnessMapTransform))),p.clearcoat>0&&(m.clearcoat.value=p.clearcoat,m.clearcoatRoughness.value=p.clearcoatRoughness,p.clearcoatMap&&(m.clearcoatMap.value=p.clearcoatMap,t(p.clearcoatMap,m.clearcoatMapTransform)),p.clearcoatRoughnessMap&&(m.clearcoatRoughnessMap.value=p.clearcoatRoughnessMap,t(p.clearcoatRoughnessMap,m.clearcoatRoughnessMapTransform)),p.clearcoatNormalMap&&(m.clearcoatNormalMap.value=p.clearcoatNormalMap,t(p.clearcoatNormalMap,m.clearcoatNormalMapTransform),m.clearcoatNormalScale.value.copy(p.clearcoatNormalScale),p.side===Nt&&m.clearcoatNormalScale.value.negate())),p.dispersion>0&&(m.dispersion.value=p.dispersion),p.retroreflectivity>0&&(m.retroreflectivity.value=p.retroreflectivity),p.iridescence>0&&(m.iridescence.value=p.iridescence,m.iridescenceIOR.value=p.iridescenceIOR,m.iridescenceThicknessMinimum.value=p.iridescenceThicknessMinimum,m.iridescenceThicknessMaximum.value=p.iridescenceThicknessMaximum,p.iridescenceMap&&(m.iridescenceMap.value=p.iridescenceMap,t(p.iridescenceMap,m.iridescenceMapTransform)),p.iridescenceThicknessMap&&(m.iridescenceThicknessMap.value=p.iridescenceThicknessMap,t(p.iridescenceThicknessMap,m.iridescenceThicknessMapTransform))),p.transmission>0&&(m.transmission.value=p.transmission,m.transmissionSamplerMap.value=_.texture,m.transmissionSamplerSize.value.set(_.width,_.height),p.transmissionMap&&(m.transmissionMap.value=p.transmissionMap,t(p.transmissionMap,m.transmissionMapTransform)),m.thickness.value=p.thickness,p.thicknessMap&&(m.thicknessMap.value=p.thicknessMap,t(p.thicknessMap,m.thicknessMapTransform)),m.attenuationDistance.value=p.attenuationDistance,m.attenuationColor.value.copy(p.attenuationColor)),p.anisotropy>0&&(m.anisotropyVector.value.set(p.anisotropy*Math.cos(p.anisotropyRotation),p.anisotropy*Math.sin(p.anisotropyRotation)),p.anisotropyMap&&(m.anisotropyMap.value=p.anisotropyMap,t(p.anisotropyMap,m.anisotropyMapTransform))),m.specularIntensity.value=p.specularIntensity,m.specularColor.value.copy(p.specularColor),p.specularColorMap&&(m.specularColorMap.value=p.specularColorMap,t(p.specularColorMap,m.specularColorMapTransform)),p.specularIntensityMap&&(m.specularIntensityMap.value=p.specularIntensityMap,t(p.specularIntensityMap,m.specularIntensityMapTransform))}function v(m,p){p.matcap&&(m.matcap.value=p.matcap)}function S(m,p){let _=e.get(p).light;m.referencePosition.value.setFromMatrixPosition(_.matrixWorld),m.nearDistance.value=_.shadow.camera.near,m.farDistance.value=_.shadow.camera.far}return{refreshFogUniforms:n,refreshMaterialUniforms:s}}function Hv(i,e,t,n){let s={},r={};function o(_,R){let w=R.program;n.uniformBlockBinding(_,w,s[_.id])}function a(_,R){let w=s[_.id];w===void 0&&(v(_),w=l(_),s[_.id]=w,_.addEventListener("dispose",m));let T=R.program;n.updateUBOMapping(_,T);let E=e.render.frame;r[_.id]!==E&&(c(_),r[_.id]=E)}function l(_){let R=i.createBuffer(),w=_.Us,T=_.usage;return i.bindBuffer(i.UNIFORM_BUFFER,R),i.bufferData(i.UNIFORM_BUFFER,w,T),i.bindBuffer(i.UNIFORM_BUFFER,null),R}function c(_){let R=s[_.id],w=_.uniforms,T=_.Os;i.bindBuffer(i.UNIFORM_BUFFER,R);for(let E=0,g=w.length;E<g;E++){let b=w[E];if(Array.isArray(b))for(let k=0,L=b.length;k<L;k++)h(b[k],E,k,T);else h(b,E,0,T)}i.bindBuffer(i.UNIFORM_BUFFER,null)}function h(_,R,w,T){if(u(_,R,w,T)===!0){let E=_.Fs,g=_.value;if(Array.isArray(g)){let b=0;for(let k=0;k<g.length;k++){let L=g[k],D=S(L,!0);d(L,_.fn,b),b+=D.storage/Float32Array.BYTES_PER_ELEMENT}}else d(g,_.fn,0);i.bufferSubData(i.UNIFORM_BUFFER,E,_.fn)}}function d(_,R,w){typeof _=="number"||typeof _=="boolean"?R[w]=_:_.isMatrix3?(R[w]=_.elements[0],R[w+1]=_.elements[1],R[w+2]=_.elements[2],R[w+3]=0,R[w+4]=_.elements[3],R[w+5]=_.elements[4],R[w+6]=_.elements[5],R[w+7]=0,R[w+8]=_.elements[6],R[w+9]=_.elements[7],R[w+10]=_.elements[8],R[w+11]=0):ArrayBuffer.isView(_)?R.set(_.subarray(0,R.length-w),w):_.toArray(R,w)}function u(_,R,w,T){let E=_.value,g=R+"_"+w;if(Array.isArray(E)){T[g]===void 0&&(T[g]=[]);let b=T[g],k=!1;for(let L=0;L<E.length;L++)f(E[L],b,L)===!0&&(k=!0);return k}return f(E,T,g)}function f(_,R,w){if(R[w]===void 0)return typeof _=="number"||typeof _=="boolean"?R[w]=_:ArrayBuffer.isView(_)?R[w]=_.slice():R[w]=_.clone(),!0;{let T=R[w];if(typeof _=="number"||typeof _=="boolean"){if(T!==_)return R[w]=_,!0}else{if(ArrayBuffer.isView(_))return!0;if(T.equals(_)===!1)return T.copy(_),!0}}return!1}function v(_){let R=_.uniforms,w=0,T=16;for(let g=0,b=R.length;g<b;g++){let k=Array.isArray(R[g])?R[g]:[R[g]];for(let L=0,D=k.length;L<D;L++){let G=k[L],$=Array.isArray(G.value)?G.value:[G.value],P=Array.isArray(R[g])||Array.isArray(G.value),q=w;for(let V=0,re=$.length;V<re;V++){let X=$[V],te=S(X,P),ie=w%T,Ee=ie%te.boundary,Fe=ie+Ee;w+=Ee,Fe!==0&&T-Fe<te.storage&&(w+=T-Fe),V===0&&(q=w),w+=te.storage}let K=G.type==="int"?Int32Array:G.type==="uint"?Uint32Array:Float32Array;G.fn=new K((w-q)/Float32Array.BYTES_PER_ELEMENT),G.Fs=q}}let E=w%T;return E>0&&(w+=T-E),_.Us=w,_.Os={},this}function S(_,R){let w={boundary:0,storage:0};return typeof _=="number"||typeof _=="boolean"?(w.boundary=4,w.storage=4):_.isVector2?(w.boundary=8,w.storage=8):_.isVector3||_.isColor?(w.boundary=16,w.storage=12):_.isVector4?(w.boundary=16,w.storage=16):_.isMatrix3?(w.boundary=16,w.storage=48):_.isMatrix4?(w.boundary=16,w.storage=64):_.isTexture?Ce("WebGLRenderer: Texture samplers can not be part of an uniforms group."):ArrayBuffer.isView(_)?(w.boundary=16,w.storage=_.byteLength):Ce("WebGLRenderer: Unsupported uniform value type.",_),R===!0&&(w.boundary=16,w.storage=Math.ceil(w.storage/16)*16),w}function m(_){let R=_.target;R.removeEventListener("dispose",m),i.deleteBuffer(s[R.id]),delete s[R.id],delete r[R.id]}function p(){for(let _ in s)i.deleteBuffer(s[_]);s={},r={}}return{bind:o,update:a,dispose:p}}var Wv=new Uint16Array([12469,15057,12620,14925,13266,14620,13807,14376,14323,13990,14545,13625,14713,13328,14840,12882,14931,12528,14996,12233,15039,11829,15066,11525,15080,11295,15085,10976,15082,10705,15073,10495,13880,14564,13898,14542,13977,14430,14158,14124,14393,13732,14556,13410,14702,12996,14814,12596,14891,12291,14937,11834,14957,11489,14958,11194,14943,10803,14921,10506,14893,10278,14858,9960,14484,14039,14487,14025,14499,13941,14524,13740,14574,13468,14654,13106,14743,12678,14818,12344,14867,11893,14889,11509,14893,11180,14881,10751,14852,10428,14812,10128,14765,9754,14712,9466,14764,13480,14764,13475,14766,13440,14766,13347,14769,13070,14786,12713,14816,12387,14844,11957,14860,11549,14868,11215,14855,10751,14825,10403,14782,10044,14729,9651,14666,9352,14599,9029,14967,12835,14966,12831,14963,12804,14954,12723,14936,12564,14917,12347,14900,11958,14886,11569,14878,11247,14859,10765,14828,10401,14784,10011,14727,9600,14660,9289,14586,8893,14508,8533,15111,12234,15110,12234,15104,12216,15092,12156,15067,12010,15028,11776,14981,11500,14942,11205,14902,10752,14861,10393,14812,9991,14752,9570,14682,9252,14603,8808,14519,8445,14431,8145,15209,11449,15208,11451,15202,11451,15190,11438,15163,11384,15117,11274,15055,10979,14994,10648,14932,10343,14871,9936,14803,9532,14729,9218,14645,8742,14556,8381,14461,8020,14365,7603,15273,10603,15272,10607,15267,10619,15256,10631,15231,10614,15182,10535,15118,10389,15042,10167,14963,9787,14883,9447,14800,9115,14710,8665,14615,8318,14514,7911,14411,7507,14279,7198,15314,9675,15313,9683,15309,9712,15298,9759,15277,9797,15229,9773,15166,9668,15084,9487,14995,9274,14898,8910,14800,8539,14697,8234,14590,7790,14479,7409,14367,7067,14178,6621,15337,8619,15337,8631,15333,8677,15325,8769,15305,8871,15264,8940,15202,8909,15119,8775,15022,8565,14916,8328,14804,8009,14688,7614,14569,7287,14448,6888,14321,6483,14088,6171,15350,7402,15350,7419,15347,7480,15340,7613,15322,7804,15287,7973,15229,8057,15148,8012,15046,7846,14933,7611,14810,7357,14682,7069,14552,6656,14421,6316,14251,5948,14007,5528,15356,5942,15356,5977,15353,6119,15348,6294,15332,6551,15302,6824,15249,7044,15171,7122,15070,7050,14949,6861,14818,6611,14679,6349,14538,6067,14398,5651,14189,5311,13935,4958,15359,4123,15359,4153,15356,4296,15353,4646,15338,5160,15311,5508,15263,5829,15188,6042,15088,6094,14966,6001,14826,5796,14678,5543,14527,5287,14377,4985,14133,4586,13869,4257,15360,1563,15360,1642,15358,2076,15354,2636,15341,3350,15317,4019,15273,4429,15203,4732,15105,4911,14981,4932,14836,4818,14679,4621,14517,4386,14359,4156,14083,3795,13808,3437,15360,122,15360,137,15358,285,15355,636,15344,1274,15322,2177,15281,2765,15215,3223,15120,3451,14995,3569,14846,3567,14681,3466,14511,3305,14344,3121,14037,2800,13753,2467,15360,0,15360,1,15359,21,15355,89,15346,253,15325,479,15287,796,15225,1148,15133,1492,15008,1749,14856,1882,14685,1886,14506,1783,14324,1608,13996,1398,13702,1183]),Pn=null;function Xv(){return Pn===null&&(Pn=new oo(Wv,16,16,xi,Mn),Pn.name="DFG_LUT",Pn.minFilter=Vt,Pn.magFilter=Vt,Pn.wrapS=An,Pn.wrapT=An,Pn.generateMipmaps=!1,Pn.needsUpdate=!0),Pn}var ma=class{constructor(e={}){let{canvas:t=iu(),context:n=null,depth:s=!0,stencil:r=!1,alpha:o=!1,antialias:a=!1,premultipliedAlpha:l=!0,preserveDrawingBuffer:c=!1,powerPreference:h="default",failIfMajorPerformanceCaveat:d=!1,reversedDepthBuffer:u=!1,outputBufferType:f=sn}=e;this.isWebGLRenderer=!0;let v;if(n!==null){if(typeof WebGLRenderingContext<"u"&&n instanceof WebGLRenderingContext)throw new Error("THREE.WebGLRenderer: WebGL 1 is not supported since r163.");v=n.getContextAttributes().alpha}else v=o;let S=f,m=new Set([Uo,Do,No]),p=new Set([sn,yn,ds,Ni,Lo,Io]),_=new Uint32Array(4),R=new Int32Array(4),w={textures:[],min:[],max:[],resolution:[]},T=null,E=null,g=[],b=[],k=null;this.domElement=t,this.debug={checkShaderErrors:!0,diagnostics:{keywords:!1},onShaderError:null},this.autoClear=!0,this.autoClearColor=!0,this.autoClearDepth=!0,this.autoClearStencil=!0,this.sortObjects=!0,this.clippingPlanes=[],this.localClippingEnabled=!1,this.toneMapping=Cn,this.toneMappingExposure=1,this.transmissionResolutionScale=1;let L=this,D=!1,G=null,$=null,P=null,q=null;this.di=Kt;let K=0,V=0,re=null,X=-1,te=null,ie=new dt,Ee=new dt,Fe=null,j=new Ze(0),xe=0,be=t.width,Pe=t.height,ye=1,ke=null,pt=null,Ie=new dt(0,0,be,Pe),et=new dt(0,0,be,Pe),nt=!1,We=new Wn,Ct=new ao,vt=!1,Xt=!1,ct=new lt,_n=new N,_t=new dt,rn={background:null,fog:null,environment:null,overrideMaterial:null,isScene:!0},on=!1;function an(){return re===null?ye:1}let I=n;function ln(y,C){return t.getContext(y,C)}let ot,at,me,xt,Le,Oe,M,x,O,se,ee,le,fe,Y,Z,he,A,J,H,ue,ae,ce,Te;try{let y={alpha:!0,depth:s,stencil:r,antialias:a,premultipliedAlpha:l,preserveDrawingBuffer:c,powerPreference:h,failIfMajorPerformanceCaveat:d};if("setAttribute"in t&&t.setAttribute("data-engine",`three.js r${"187"}`),t.addEventListener("webglcontextlost",Re,!1),t.addEventListener("webglcontextrestored",ze,!1),t.addEventListener("webglcontextcreationerror",ge,!1),I===null){let C="webgl2";if(I=ln(C,y),I===null)throw ln(C)?new Error("THREE.WebGLRenderer: Error creating WebGL context with your selected attributes."):new Error("THREE.WebGLRenderer: Error creating WebGL context.")}Ge()}catch(y){throw t.removeEventListener("webglcontextlost",Re,!1),t.removeEventListener("webglcontextrestored",ze,!1),t.removeEventListener("webglcontextcreationerror",ge,!1),Ne("WebGLRenderer: "+y.message),y}function Ge(){ot=new n0(I),ot.init(),ae=new Bv(I,ot),at=new Xg(I,ot,e,ae),me=new Ov(I,ot),at.reversedDepthBuffer&&u&&me.buffers.depth.setReversed(!0),$=I.createFramebuffer(),P=I.createFramebuffer(),q=I.createFramebuffer(),xt=new r0(I),Le=new bv,Oe=new Fv(I,ot,me,Le,at,ae,xt),M=new t0(L),x=new ap(I),ce=new Hg(I,x),O=new i0(I,x,xt,ce),se=new a0(I,O,x,ce,xt),J=new o0(I,at,Oe),Z=new qg(Le),ee=new Mv(L,M,ot,at,ce,Z),le=new Vv(L,Le),fe=new wv,Y=new Pv(ot),A=new Vg(L,M,me,se,v,l),he=new Uv(L,se,at),Te=new Hv(I,xt,at,me),H=new Wg(I,ot,xt),ue=new s0(I,ot,xt),xt.programs=ee.programs,L.capabilities=at,L.extensions=ot,L.properties=Le,L.renderLists=fe,L.shadowMap=he,L.state=me,L.info=xt}S!==sn&&(k=new c0(S,t.width,t.height,a,s,r));let oe=new ic(L,I);this.xr=oe,this.getContext=function(){return I},this.getContextAttributes=function(){return I.getContextAttributes()},this.forceContextLoss=function(){let y=ot.get("WEBGL_lose_context");y&&y.loseContext()},this.forceContextRestore=function(){let y=ot.get("WEBGL_lose_context");y&&y.restoreContext()},this.getPixelRatio=function(){return ye},this.setPixelRatio=function(y){y!==void 0&&(ye=y,this.setSize(be,Pe,!1))},this.getSize=function(y){return y.set(be,Pe)},this.setSize=function(y,C,z=!0){if(oe.isPresenting){Ce("WebGLRenderer: Can't change size while VR device is presenting.");return}be=y,Pe=C,t.width=Math.floor(y*ye),t.height=Math.floor(C*ye),z===!0&&(t.style.width=y+"px",t.style.height=C+"px"),k!==null&&k.setSize(t.width,t.height),this.setViewport(0,0,y,C)},this.getDrawingBufferSize=function(y){return y.set(be*ye,Pe*ye).floor()},this.setDrawingBufferSize=function(y,C,z){be=y,Pe=C,ye=z,t.width=Math.floor(y*z),t.height=Math.floor(C*z),this.setViewport(0,0,y,C)},this.setEffects=function(y){if(S===sn){Ne("WebGLRenderer: setEffects() requires outputBufferType set to HalfFloatType or FloatType.");return}if(y){for(let C=0;C<y.length;C++)if(y[C].isOutputPass===!0){Ce("WebGLRenderer: OutputPass is not needed in setEffects(). Tone mapping and color space conversion are applied automatically.");break}}k.setEffects(y||[])},this.getCurrentViewport=function(y){return y.copy(ie)},this.getViewport=function(y){return y.copy(Ie)},this.setViewport=function(y,C,z,U){y.isVector4?Ie.set(y.x,y.y,y.z,y.w):Ie.set(y,C,z,U),me.viewport(ie.copy(Ie).multiplyScalar(an()).round())},this.getScissor=function(y){return y.copy(et)},this.setScissor=function(y,C,z,U){y.isVector4?et.set(y.x,y.y,y.z,y.w):et.set(y,C,z,U),me.scissor(Ee.copy(et).multiplyScalar(an()).round())},this.getScissorTest=function(){return nt},this.setScissorTest=function(y){me.setScissorTest(nt=y)},this.setOpaqueSort=function(y){ke=y},this.setTransparentSort=function(y){pt=y},this.getClearColor=function(y){return y.copy(A.getClearColor())},this.setClearColor=function(){A.setClearColor(...arguments)},this.getClearAlpha=function(){return A.getClearAlpha()},this.setClearAlpha=function(){A.setClearAlpha(...arguments)},this.clear=function(y=!0,C=!0,z=!0){let U=0;if(y){let F=!1;if(re!==null){let pe=re.texture.format;F=m.has(pe)}if(F){let pe=re.texture.type,Me=p.has(pe),de=A.getClearColor(),Se=A.getClearAlpha(),Ae=de.r,Be=de.g,Xe=de.b;Me?(_[0]=Ae,_[1]=Be,_[2]=Xe,_[3]=Se,I.clearBufferuiv(I.COLOR,0,_)):(R[0]=Ae,R[1]=Be,R[2]=Xe,R[3]=Se,I.clearBufferiv(I.COLOR,0,R))}else U|=I.COLOR_BUFFER_BIT}C&&(U|=I.DEPTH_BUFFER_BIT,this.state.buffers.depth.setMask(!0)),z&&(U|=I.STENCIL_BUFFER_BIT,this.state.buffers.stencil.setMask(4294967295)),U!==0&&I.clear(U)},this.clearColor=function(){this.clear(!0,!1,!1)},this.clearDepth=function(){this.clear(!1,!0,!1)},this.clearStencil=function(){this.clear(!1,!1,!0)},this.setNodesHandler=function(y){y.setRenderer(this),G=y},this.dispose=function(){t.removeEventListener("webglcontextlost",Re,!1),t.removeEventListener("webglcontextrestored",ze,!1),t.removeEventListener("webglcontextcreationerror",ge,!1),A.dispose(),fe.dispose(),Y.dispose(),Oe.dispose(),Le.dispose(),M.dispose(),se.dispose(),O.dispose(),ce.dispose(),Te.dispose(),ee.dispose(),oe.dispose(),oe.removeEventListener("sessionstart",Tc),oe.removeEventListener("sessionend",Rc),Mi.stop()};function Re(y){y.preventDefault(),kl("WebGLRenderer: Context Lost."),D=!0}function ze(){kl("WebGLRenderer: Context Restored."),D=!1;let y=xt.autoReset,C=he.enabled,z=he.autoUpdate,U=he.needsUpdate,F=he.type;Ge(),xt.autoReset=y,he.enabled=C,he.autoUpdate=z,he.needsUpdate=U,he.type=F}function ge(y){Ne("WebGLRenderer: A WebGL context could not be created. Reason: ",y.statusMessage)}function tt(y){let C=y.target;C.removeEventListener("dispose",tt),wt(C)}function wt(y){Kn(y),Le.remove(y)}function Kn(y){let C=Le.get(y).programs;C!==void 0&&(C.forEach(function(z){ee.releaseProgram(z)}),y.isShaderMaterial&&ee.releaseShaderCache(y))}this.renderBufferDirect=function(y,C,z,U,F,pe){C===null&&(C=rn);let Me=F.isMesh&&F.matrixWorld.determinantAffine()<0,de=qd(y,C,z,U,F);me.setMaterial(U,Me);let Se=z.index,Ae=1;if(U.wireframe===!0){if(Se=O.getWireframeAttribute(z),Se===void 0)return;Ae=2}let Be=z.drawRange,Xe=z.attributes.position,_e=Be.start*Ae,qe=(Be.start+Be.count)*Ae;pe!==null&&(_e=Math.max(_e,pe.start*Ae),qe=Math.min(qe,(pe.start+pe.count)*Ae)),Se!==null?(_e=Math.max(_e,0),qe=Math.min(qe,Se.count)):Xe!=null&&(_e=Math.max(_e,0),qe=Math.min(qe,Xe.count));let mt=qe-_e;if(mt<0||mt===1/0)return;ce.setup(F,U,de,z,Se);let st,it=H;if(Se!==null&&(st=x.get(Se),it=ue,it.setIndex(st)),F.isMesh)U.wireframe===!0?(me.setLineWidth(U.wireframeLinewidth*an()),it.setMode(I.LINES)):it.setMode(I.TRIANGLES);else if(F.isLine){let Ut=U.linewidth;Ut===void 0&&(Ut=1),me.setLineWidth(Ut*an()),F.isLineSegments?it.setMode(I.LINES):F.isLineLoop?it.setMode(I.LINE_LOOP):it.setMode(I.LINE_STRIP)}else F.isPoints?it.setMode(I.POINTS):F.isSprite&&it.setMode(I.TRIANGLES);if(F.isBatchedMesh)if(ot.get("WEBGL_multi_draw"))it.renderMultiDraw(F.Se,F.ye,F.Bt);else{let Ut=F.Se,we=F.ye,zt=F.Bt,Je=Se?x.get(Se).bytesPerElement:1,bi=Le.get(U).currentProgram.getUniforms();for(let Ot=0;Ot<zt;Ot++)bi.setValue(I,"_gl_DrawID",Ot),it.render(Ut[Ot]/Je,we[Ot])}else if(F.isInstancedMesh)it.renderInstances(_e,mt,F.count);else if(z.isInstancedBufferGeometry){let Ut=z.O!==void 0?z.O:1/0,we=Math.min(z.instanceCount,Ut);it.renderInstances(_e,mt,we)}else it.render(_e,mt)};function Ac(y,C,z,U){G!==null&&y.isNodeMaterial&&G.setObject(U,y),vt===!0&&Z.setState(y,z,!1),y.transparent===!0&&y.side===Wt&&y.forceSinglePass===!1?(y.side=Nt,y.needsUpdate=!0,vs(y,C,U),y.side=Rn,y.needsUpdate=!0,vs(y,C,U),y.side=Wt):vs(y,C,U)}this.compile=function(y,C,z=null){z===null&&(z=y),G!==null&&G.renderStart(y,C,z),E=Y.get(z),E.init(C),b.push(E),z.traverseVisible(function(F){F.isLight&&F.layers.test(C.layers)&&(E.pushLight(F),F.castShadow&&E.pushShadow(F))}),y!==z&&y.traverseVisible(function(F){F.isLight&&F.layers.test(C.layers)&&(E.pushLight(F),F.castShadow&&E.pushShadow(F))}),E.setupLights(),G!==null&&G.updateLights(E.state.lightsArray),Xt=this.localClippingEnabled,vt=Z.init(this.clippingPlanes,Xt),vt===!0&&Z.setGlobalState(this.clippingPlanes,C),G!==null&&he.render(E.state.shadowsArray,z,C);let U=new Set;return y.traverse(function(F){if(!(F.isMesh||F.isPoints||F.isLine||F.isSprite))return;let pe=F.material;if(pe)if(Array.isArray(pe))for(let Me=0;Me<pe.length;Me++){let de=pe[Me];Ac(de,z,C,F),U.add(de)}else Ac(pe,z,C,F),U.add(pe)}),E=b.pop(),G!==null&&G.renderEnd(),U},this.compileAsync=function(y,C,z=null){let U=this.compile(y,C,z);return new Promise(F=>{function pe(){if(U.forEach(function(Me){let Se=Le.get(Me).currentProgram;(Se===void 0||Se.isReady())&&U.delete(Me)}),U.size===0){F(y);return}setTimeout(pe,10)}ot.get("KHR_parallel_shader_compile")!==null?pe():setTimeout(pe,10)})};let Na=null;function Wd(y){Na&&Na(y)}function Tc(){Mi.stop()}function Rc(){Mi.start()}let Mi=new Du;Mi.setAnimationLoop(Wd),typeof self<"u"&&Mi.setContext(self),this.setAnimationLoop=function(y){Na=y,oe.setAnimationLoop(y),y===null?Mi.stop():Mi.start()},oe.addEventListener("sessionstart",Tc),oe.addEventListener("sessionend",Rc),this.render=function(y,C){if(C!==void 0&&C.isCamera!==!0){Ne("WebGLRenderer.render: camera is not an instance of THREE.Camera.");return}if(D===!0)return;G!==null&&G.renderStart(y,C);let z=oe.enabled===!0&&oe.isPresenting===!0,U=k!==null&&(re===null||z)&&k.begin(L,re);if(y.matrixWorldAutoUpdate===!0&&y.updateMatrixWorld(),C.parent===null&&C.matrixWorldAutoUpdate===!0&&C.updateMatrixWorld(),oe.enabled===!0&&oe.isPresenting===!0&&(k===null||k.isCompositing()===!1)&&(oe.cameraAutoUpdate===!0&&oe.updateCamera(C),C=oe.getCamera()),y.isScene===!0&&y.onBeforeRender(L,y,C,re),E=Y.get(y,b.length),E.init(C),E.state.textureUnits=Oe.getTextureUnits(),b.push(E),ct.multiplyMatrices(C.projectionMatrix,C.matrixWorldInverse),C.isArrayCamera?Ct.setFromArrayCamera(C):We.setFromProjectionMatrix(ct,hn,C.reversedDepth),Xt=this.localClippingEnabled,vt=Z.init(this.clippingPlanes,Xt),T=fe.get(y,g.length),T.init(),g.push(T),this.info.render.frame++,oe.enabled===!0&&oe.isPresenting===!0){let Me=L.xr.getDepthSensingMesh();Me!==null&&Da(Me,C,-1/0,L.sortObjects)}Da(y,C,0,L.sortObjects),T.finish(),G!==null&&G.updateLights(E.state.lightsArray),L.sortObjects===!0&&T.sort(ke,pt),on=oe.enabled===!1||oe.isPresenting===!1||oe.hasDepthSensing()===!1,on&&A.addToRenderList(T,y),this.info.autoReset===!0&&this.info.reset(),vt===!0&&Z.beginShadows();let F=E.state.shadowsArray;if(he.render(F,y,C),vt===!0&&Z.endShadows(),(U&&k.hasRenderPass())===!1){let Me=T.opaque,de=T.transmissive;if(E.setupLights(),C.isArrayCamera){let Se=C.cameras;if(de.length>0)for(let Ae=0,Be=Se.length;Ae<Be;Ae++){let Xe=Se[Ae];Pc(Me,de,y,Xe)}on&&A.render(y);for(let Ae=0,Be=Se.length;Ae<Be;Ae++){let Xe=Se[Ae];Cc(T,y,Xe,Xe.viewport)}}else de.length>0&&Pc(Me,de,y,C),on&&A.render(y),Cc(T,y,C)}re!==null&&V===0&&(Oe.updateMultisampleRenderTarget(re),Oe.updateRenderTargetMipmap(re)),U&&k.end(L),y.isScene===!0&&y.onAfterRender(L,y,C),ce.resetDefaultState(),X=-1,te=null,b.pop(),b.length>0?(E=b[b.length-1],Oe.setTextureUnits(E.state.textureUnits),vt===!0&&Z.setGlobalState(L.clippingPlanes,E.state.camera)):E=null,g.pop(),g.length>0?T=g[g.length-1]:T=null,G!==null&&G.renderEnd()};function Da(y,C,z,U){if(y.visible===!1)return;if(y.layers.test(C.layers)){if(y.isGroup)z=y.renderOrder;else if(y.isLOD)y.autoUpdate===!0&&y.update(C);else if(y.isLight)E.pushLight(y),y.castShadow&&E.pushShadow(y);else if(y.isSprite){let Me=C.isArrayCamera?Ct:We;if(!y.frustumCulled||y.intersectsFrustum(Me)){U&&_t.setFromMatrixPosition(y.matrixWorld).applyMatrix4(ct);let de=se.update(y),Se=y.material;Se.visible&&T.push(y,de,Se,z,_t.z,null,C)}}else if(y.isMesh||y.isLine||y.isPoints){let Me=C.isArrayCamera?Ct:We;if(!y.frustumCulled||y.intersectsFrustum(Me)){let de=se.update(y),Se=y.material;if(U&&(y.boundingSphere!==void 0?(y.boundingSphere===null&&y.computeBoundingSphere(),_t.copy(y.boundingSphere.center)):(de.boundingSphere===null&&de.computeBoundingSphere(),_t.copy(de.boundingSphere.center)),_t.applyMatrix4(y.matrixWorld).applyMatrix4(ct)),Array.isArray(Se)){let Ae=de.groups;for(let Be=0,Xe=Ae.length;Be<Xe;Be++){let _e=Ae[Be],qe=Se[_e.materialIndex];qe&&qe.visible&&T.push(y,de,qe,z,_t.z,_e,C)}}else Se.visible&&T.push(y,de,Se,z,_t.z,null,C)}}}let pe=y.children;for(let Me=0,de=pe.length;Me<de;Me++)Da(pe[Me],C,z,U)}function Cc(y,C,z,U){let{opaque:F,transmissive:pe,transparent:Me}=y;E.setupLightsView(z),vt===!0&&Z.setGlobalState(L.clippingPlanes,z),U&&me.viewport(ie.copy(U)),F.length>0&&dr(F,C,z),pe.length>0&&dr(pe,C,z),Me.length>0&&dr(Me,C,z),me.buffers.depth.setTest(!0),me.buffers.depth.setMask(!0),me.buffers.color.setMask(!0),me.setPolygonOffset(!1)}function Pc(y,C,z,U){if((z.isScene===!0?z.overrideMaterial:null)!==null)return;if(E.state.transmissionRenderTarget[U.id]===void 0){let _e=ot.has("EXT_color_buffer_half_float")||ot.has("EXT_color_buffer_float");E.state.transmissionRenderTarget[U.id]=new tn(1,1,{generateMipmaps:!0,type:_e?Mn:sn,minFilter:qn,samples:Math.max(4,at.samples),stencilBuffer:r,resolveDepthBuffer:!1,resolveStencilBuffer:!1,storeMultisampledDepthBuffer:!1,storeMultisampledStencilBuffer:!1,colorSpace:Ye.workingColorSpace})}let pe=E.state.transmissionRenderTarget[U.id],Me=U.viewport||ie;pe.setSize(Me.z*L.transmissionResolutionScale,Me.w*L.transmissionResolutionScale);let de=L.getRenderTarget(),Se=L.getActiveCubeFace(),Ae=L.getActiveMipmapLevel();L.setRenderTarget(pe),L.getClearColor(j),xe=L.getClearAlpha(),xe<1&&L.setClearColor(16777215,.5),L.clear(),on&&A.render(z);let Be=L.toneMapping;L.toneMapping=Cn;let Xe=U.viewport;if(U.viewport!==void 0&&(U.viewport=void 0),E.setupLightsView(U),vt===!0&&Z.setGlobalState(L.clippingPlanes,U),dr(y,z,U),Oe.updateMultisampleRenderTarget(pe),Oe.updateRenderTargetMipmap(pe),ot.has("WEBGL_multisampled_render_to_texture")===!1){let _e=!1;for(let qe=0,mt=C.length;qe<mt;qe++){let st=C[qe],{object:it,geometry:Ut,material:we,group:zt}=st;if(we.side===Wt&&it.layers.test(U.layers)){let Je=we.side;we.side=Nt,we.needsUpdate=!0,Lc(it,z,U,Ut,we,zt),we.side=Je,we.needsUpdate=!0,_e=!0}}_e===!0&&(Oe.updateMultisampleRenderTarget(pe),Oe.updateRenderTargetMipmap(pe))}L.setRenderTarget(de,Se,Ae),L.setClearColor(j,xe),Xe!==void 0&&(U.viewport=Xe),L.toneMapping=Be}function dr(y,C,z){let U=C.isScene===!0?C.overrideMaterial:null;for(let F=0,pe=y.length;F<pe;F++){let Me=y[F],{object:de,geometry:Se,group:Ae}=Me,Be=Me.material;Be.allowOverride===!0&&U!==null&&(Be=U),de.layers.test(z.layers)&&Lc(de,C,z,Se,Be,Ae)}}function Lc(y,C,z,U,F,pe){G!==null&&F.isNodeMaterial&&G.setObject(y,F),y.onBeforeRender(L,C,z,U,F,pe),y.modelViewMatrix.multiplyMatrices(z.matrixWorldInverse,y.matrixWorld),y.normalMatrix.getNormalMatrix(y.modelViewMatrix),F.onBeforeRender(L,C,z,U,y,pe),F.transparent===!0&&F.side===Wt&&F.forceSinglePass===!1?(F.side=Nt,F.needsUpdate=!0,L.renderBufferDirect(z,C,U,F,y,pe),F.side=Rn,F.needsUpdate=!0,L.renderBufferDirect(z,C,U,F,y,pe),F.side=Wt):L.renderBufferDirect(z,C,U,F,y,pe),y.onAfterRender(L,C,z,U,F,pe)}function Ic(y){let C=0;for(let z of y)z.texture!==null&&C++;return C}function vs(y,C,z){C.isScene!==!0&&(C=rn);let U=Le.get(y),F=E.state.lights,pe=E.state.shadowsArray,Me=F.state.version,de=ee.getParameters(y,F.state,pe,C,z,E.state.lightProbeGridArray),Se=ee.getProgramCacheKey(de),Ae=U.programs;U.environment=y.isMeshStandardMaterial||y.isMeshLambertMaterial||y.isMeshPhongMaterial?C.environment:null,U.fog=C.fog;let Be=y.isMeshStandardMaterial||y.isMeshLambertMaterial&&!y.envMap||y.isMeshPhongMaterial&&!y.envMap;U.envMap=M.get(y.envMap||U.environment,Be),U.envMapRotation=U.environment!==null&&y.envMap===null?C.environmentRotation:y.envMapRotation,Ae===void 0&&(y.addEventListener("dispose",tt),Ae=new Map,U.programs=Ae,U.programVariants=new Map);let Xe=Ae.get(Se);if(Xe!==void 0){if(U.currentProgram===Xe&&U.lightsStateVersion===Me)return Dc(y,de),Xe}else de.uniforms=ee.getUniforms(y),G!==null&&y.isNodeMaterial&&G.build(y,z,de),y.onBeforeCompile(de,L),Xe=ee.acquireProgram(de,Se),Ae.set(Se,Xe),U.uniforms=de.uniforms;let _e=U.uniforms;return(!y.isShaderMaterial&&!y.isRawShaderMaterial||y.clipping===!0)&&(_e.clippingPlanes=Z.uniform),Dc(y,de),U.needsLights=$d(y),U.lightsStateVersion=Me,U.needsLights&&(_e.ambientLightColor.value=F.state.ambient,_e.lightProbe.value=F.state.probe,_e.sunLights.value=F.state.sun,_e.sunLightShadows.value=F.state.sunShadow,_e.directionalLights.value=F.state.directional,_e.directionalLightShadows.value=F.state.directionalShadow,_e.spotLights.value=F.state.spot,_e.spotLightShadows.value=F.state.spotShadow,_e.rectAreaLights.value=F.state.rectArea,_e.ltc_1.value=F.state.rectAreaLTC1,_e.ltc_2.value=F.state.rectAreaLTC2,_e.pointLights.value=F.state.point,_e.pointLightShadows.value=F.state.pointShadow,_e.hemisphereLights.value=F.state.hemi,_e.sunShadowMatrix.value=F.state.sunShadowMatrix,_e.sunShadowCascade.value=F.state.sunShadowCascade,_e.directionalShadowMatrix.value=F.state.directionalShadowMatrix,_e.spotLightMatrix.value=F.state.spotLightMatrix,_e.spotLightMap.value=F.state.spotLightMap,_e.pointShadowMatrix.value=F.state.pointShadowMatrix),U.numLightProbeGrids=Ic(E.state.lightProbeGridArray),U.currentProgram=Xe,U.uniformsList=null,Xe}function Xd(y,C,z,U,F){let pe=Le.get(y),Me=pe.currentProgram.id+","+U+","+F,de=pe.programVariants.get(Me);return de===void 0?(de=vs(y,C,z),pe.programVariants.set(Me,de)):(pe.currentProgram=de,pe.uniformsList=null,pe.outputColorSpace=U,pe.toneMapping=F),de}function Nc(y){if(y.uniformsList===null){let C=y.currentProgram.getUniforms();y.uniformsList=ps.seqWithValue(C.seq,y.uniforms)}return y.uniformsList}function Dc(y,C){let z=Le.get(y);z.outputColorSpace=C.outputColorSpace,z.batching=C.batching,z.batchingColor=C.batchingColor,z.instancing=C.instancing,z.instancingColor=C.instancingColor,z.instancingMorph=C.instancingMorph,z.skinning=C.skinning,z.morphTargets=C.morphTargets,z.morphNormals=C.morphNormals,z.morphColors=C.morphColors,z.morphTargetsCount=C.morphTargetsCount,z.numClippingPlanes=C.numClippingPlanes,z.numIntersection=C.numClipIntersection,z.vertexAlphas=C.vertexAlphas,z.vertexTangents=C.vertexTangents,z.toneMapping=C.toneMapping}function qd(y,C,z,U,F){C.isScene!==!0&&(C=rn),Oe.resetTextureUnits();let pe=C.fog,Me=U.isMeshStandardMaterial||U.isMeshLambertMaterial||U.isMeshPhongMaterial?C.environment:null,de=re===null?L.outputColorSpace:re.isXRRenderTarget===!0?re.texture.colorSpace:Ye.workingColorSpace,Se=U.isMeshStandardMaterial||U.isMeshLambertMaterial&&!U.envMap||U.isMeshPhongMaterial&&!U.envMap,Ae=M.get(U.envMap||Me,Se),Be=U.vertexColors===!0&&!!z.attributes.color&&z.attributes.color.itemSize===4,Xe=!!z.attributes.tangent&&(!!U.normalMap||U.anisotropy>0),_e=!!z.morphAttributes.position,qe=!!z.morphAttributes.normal,mt=!!z.morphAttributes.color,st=Cn;U.toneMapped&&(re===null||re.isXRRenderTarget===!0)&&(st=L.toneMapping);let it=z.morphAttributes.position||z.morphAttributes.normal||z.morphAttributes.color,Ut=it!==void 0?it.length:0,we=Le.get(U),zt=E.state.lights;if(vt===!0&&(Xt===!0||y!==te)){let ht=y===te&&U.id===X;Z.setState(U,y,ht)}let Je=!1,bi=!1;U.version===we.X?we.needsLights&&we.lightsStateVersion!==zt.state.version||F.isBatchedMesh&&we.batching===!1||!F.isBatchedMesh&&we.batching===!0||F.isBatchedMesh&&we.batchingColor===!0&&F.T===null||F.isBatchedMesh&&we.batchingColor===!1&&F.T!==null||F.isInstancedMesh&&we.instancing===!1||!F.isInstancedMesh&&we.instancing===!0||F.isSkinnedMesh&&we.skinning===!1||!F.isSkinnedMesh&&we.skinning===!0||F.isInstancedMesh&&we.instancingColor===!0&&F.instanceColor===null||F.isInstancedMesh&&we.instancingColor===!1&&F.instanceColor!==null||F.isInstancedMesh&&we.instancingMorph===!0&&F.morphTexture===null||F.isInstancedMesh&&we.instancingMorph===!1&&F.morphTexture!==null||we.envMap!==Ae||U.fog===!0&&we.fog!==pe||we.numClippingPlanes!==void 0&&(we.numClippingPlanes!==Z.numPlanes||we.numIntersection!==Z.numIntersection)||we.vertexAlphas!==Be||we.vertexTangents!==Xe||we.morphTargets!==_e||we.morphNormals!==qe||we.morphColors!==mt||we.morphTargetsCount!==Ut||we.numLightProbeGrids!==Ic(E.state.lightProbeGridArray)?Je=!0:(we.outputColorSpace!==de||we.toneMapping!==st)&&(bi=!0):(Je=!0,we.X=U.version);let Ot=we.currentProgram;(Je===!0||bi===!0)&&(Ot=bi===!0?Xd(U,C,F,de,st):vs(U,C,F),G&&U.isNodeMaterial&&G.onUpdateProgram(U,Ot,we));let fr=!1,Qn=!1,_i=!1,je=Ot.getUniforms(),Pt=we.uniforms;if(me.useProgram(Ot.program)&&(fr=!0,Qn=!0,_i=!0),U.id!==X&&(X=U.id,Qn=!0),fr||te!==y){me.buffers.depth.getReversed()&&y.reversedDepth!==!0&&(y.Zt=!0,y.updateProjectionMatrix()),je.setValue(I,"projectionMatrix",y.projectionMatrix),je.setValue(I,"viewMatrix",y.matrixWorldInverse);let Et=je.map.cameraPosition;Et!==void 0&&Et.setValue(I,_n.setFromMatrixPosition(y.matrixWorld)),at.logarithmicDepthBuffer&&je.setValue(I,"logDepthBufFC",2/(Math.log(y.far+1)/Math.LN2)),(U.isMeshPhongMaterial||U.isMeshToonMaterial||U.isMeshLambertMaterial||U.isMeshBasicMaterial||U.isMeshStandardMaterial||U.isShaderMaterial)&&je.setValue(I,"isOrthographic",y.isOrthographicCamera===!0),te!==y&&(te=y,Qn=!0,_i=!0)}if(we.needsLights&&(zt.state.sunShadowMap.length>0&&je.setValue(I,"sunShadowMap",zt.state.sunShadowMap,Oe),zt.state.directionalShadowMap.length>0&&je.setValue(I,"directionalShadowMap",zt.state.directionalShadowMap,Oe),zt.state.spotShadowMap.length>0&&je.setValue(I,"spotShadowMap",zt.state.spotShadowMap,Oe),zt.state.pointShadowMap.length>0&&je.setValue(I,"pointShadowMap",zt.state.pointShadowMap,Oe)),F.isSkinnedMesh){je.setOptional(I,F,"bindMatrix"),je.setOptional(I,F,"bindMatrixInverse");let ht=F.skeleton;ht&&(ht.boneTexture===null&&ht.computeBoneTexture(),je.setValue(I,"boneTexture",ht.boneTexture,Oe))}F.isBatchedMesh&&(je.setOptional(I,F,"batchingTexture"),je.setValue(I,"batchingTexture",F.B,Oe),je.setOptional(I,F,"batchingIdTexture"),je.setValue(I,"batchingIdTexture",F.V,Oe),je.setOptional(I,F,"batchingColorTexture"),F.T!==null&&je.setValue(I,"batchingColorTexture",F.T,Oe));let pn=z.morphAttributes;if((pn.position!==void 0||pn.normal!==void 0||pn.color!==void 0)&&J.update(F,z,Ot),(Qn||we.receiveShadow!==F.receiveShadow)&&(we.receiveShadow=F.receiveShadow,je.setValue(I,"receiveShadow",F.receiveShadow)),(U.isMeshStandardMaterial||U.isMeshLambertMaterial||U.isMeshPhongMaterial)&&U.envMap===null&&C.environment!==null&&(Pt.envMapIntensity.value=C.environmentIntensity),Pt.dfgLUT!==void 0&&(Pt.dfgLUT.value=Xv()),Qn){if(je.setValue(I,"toneMappingExposure",L.toneMappingExposure),we.needsLights&&Yd(Pt,_i),pe&&U.fog===!0&&le.refreshFogUniforms(Pt,pe),le.refreshMaterialUniforms(Pt,U,ye,Pe,E.state.transmissionRenderTarget[y.id]),we.needsLights&&we.numLightProbeGrids>0){let ht=w,Et=0;for(let In of E.state.lightProbeGridArray)In.texture!==null&&(ht.textures[Et]=In.texture,ht.min[Et]=In.boundingBox.min,ht.max[Et]=In.boundingBox.max,ht.resolution[Et]=In.resolution,Et++);for(let In in ht)ht[In].length=Et;Pt.probesSH.value=ht.textures,Pt.probesMin.value=ht.min,Pt.probesMax.value=ht.max,Pt.probesResolution.value=ht.resolution}ps.upload(I,Nc(we),Pt,Oe)}if(U.isShaderMaterial&&U.uniformsNeedUpdate===!0&&(ps.upload(I,Nc(we),Pt,Oe),U.uniformsNeedUpdate=!1),U.isSpriteMaterial&&je.setValue(I,"center",F.center),je.setValue(I,"modelViewMatrix",F.modelViewMatrix),je.setValue(I,"normalMatrix",F.normalMatrix),je.setValue(I,"modelMatrix",F.matrixWorld),U.uniformsGroups!==void 0){let ht=U.uniformsGroups;for(let Et=0,In=ht.length;Et<In;Et++){let Oc=ht[Et];Te.update(Oc,Ot),Te.bind(Oc,Ot)}}return Ot}function Yd(y,C){y.ambientLightColor.needsUpdate=C,y.lightProbe.needsUpdate=C,y.sunLights.needsUpdate=C,y.sunLightShadows.needsUpdate=C,y.directionalLights.needsUpdate=C,y.directionalLightShadows.needsUpdate=C,y.pointLights.needsUpdate=C,y.pointLightShadows.needsUpdate=C,y.spotLights.needsUpdate=C,y.spotLightShadows.needsUpdate=C,y.rectAreaLights.needsUpdate=C,y.hemisphereLights.needsUpdate=C}function $d(y){return y.isMeshLambertMaterial||y.isMeshToonMaterial||y.isMeshPhongMaterial||y.isMeshStandardMaterial||y.isShadowMaterial||y.isShaderMaterial&&y.lights===!0}this.getActiveCubeFace=function(){return K},this.getActiveMipmapLevel=function(){return V},this.getRenderTarget=function(){return re},this.setRenderTargetTextures=function(y,C,z){let U=Le.get(y);U.dn=y.resolveDepthBuffer===!1,U.dn===!1&&(U.Ds=!1),Le.get(y.texture)._=C,Le.get(y.depthTexture)._=U.dn?void 0:z,U.ui=!0},this.setRenderTargetFramebuffer=function(y,C){let z=Le.get(y);z.M=C,z.Bs=C===void 0},this.setRenderTarget=function(y,C=0,z=0){re=y,K=C,V=z;let U=null,F=!1,pe=!1;if(y){let de=Le.get(y);if(de.Bs!==void 0){me.bindFramebuffer(I.FRAMEBUFFER,de.M),ie.copy(y.viewport),Ee.copy(y.scissor),Fe=y.scissorTest,me.viewport(ie),me.scissor(Ee),me.setScissorTest(Fe),X=-1;return}else if(de.M===void 0)Oe.setupRenderTarget(y);else if(de.ui)Oe.rebindTextures(y,Le.get(y.texture)._,Le.get(y.depthTexture)._);else if(y.depthBuffer){let Be=y.depthTexture;if(de.un!==Be){if(Be!==null&&Le.has(Be)&&(y.width!==Be.image.width||y.height!==Be.image.height))throw new Error("THREE.WebGLRenderer: Attached DepthTexture is initialized to the incorrect size.");Oe.setupDepthRenderbuffer(y)}}let Se=y.texture;(Se.isData3DTexture||Se.isDataArrayTexture||Se.isCompressedArrayTexture)&&(pe=!0);let Ae=Le.get(y).M;y.isWebGLCubeRenderTarget?(Array.isArray(Ae[C])?U=Ae[C][z]:U=Ae[C],F=!0):y.samples>0&&Oe.useMultisampledRTT(y)===!1?U=Le.get(y).ve:Array.isArray(Ae)?U=Ae[z]:U=Ae,ie.copy(y.viewport),Ee.copy(y.scissor),Fe=y.scissorTest}else ie.copy(Ie).multiplyScalar(ye).floor(),Ee.copy(et).multiplyScalar(ye).floor(),Fe=nt;if(z!==0&&(U=$),me.bindFramebuffer(I.FRAMEBUFFER,U)&&me.drawBuffers(y,U),me.viewport(ie),me.scissor(Ee),me.setScissorTest(Fe),F){let de=Le.get(y.texture);I.framebufferTexture2D(I.FRAMEBUFFER,I.COLOR_ATTACHMENT0,I.TEXTURE_CUBE_MAP_POSITIVE_X+C,de._,z)}else if(pe){let de=C;for(let Se=0;Se<y.textures.length;Se++){let Ae=Le.get(y.textures[Se]);I.framebufferTextureLayer(I.FRAMEBUFFER,I.COLOR_ATTACHMENT0+Se,Ae._,z,de)}}else if(y!==null&&z!==0){let de=Le.get(y.texture);I.framebufferTexture2D(I.FRAMEBUFFER,I.COLOR_ATTACHMENT0,I.TEXTURE_2D,de._,z)}X=-1};function Uc(y){let C=Le.get(y);return(C.ks!==y.format||C.zs!==y.type)&&(C.ks=y.format,C.zs=y.type,C.fi=at.textureFormatReadable(y.format),C.pi=at.textureTypeReadable(y.type)),C}this.readRenderTargetPixels=function(y,C,z,U,F,pe,Me,de=0){if(!(y&&y.isWebGLRenderTarget)){Ne("WebGLRenderer.readRenderTargetPixels: renderTarget is not THREE.WebGLRenderTarget.");return}let Se=Le.get(y).M;if(y.isWebGLCubeRenderTarget&&Me!==void 0&&(Se=Se[Me],Array.isArray(Se)&&(Se=Se[0])),Se){me.bindFramebuffer(I.FRAMEBUFFER,Se);try{let Ae=y.textures[de],Be=Ae.format,Xe=Ae.type;y.textures.length>1&&I.readBuffer(I.COLOR_ATTACHMENT0+de);let _e=Uc(Ae);if(_e.fi===!1){Ne("WebGLRenderer.readRenderTargetPixels: renderTarget is not in RGBA or implementation defined format.");return}if(_e.pi===!1){Ne("WebGLRenderer.readRenderTargetPixels: renderTarget is not in UnsignedByteType or implementation defined type.");return}C>=0&&C<=y.width-U&&z>=0&&z<=y.height-F&&I.readPixels(C,z,U,F,ae.convert(Be),ae.convert(Xe),pe)}finally{let Ae=re!==null?Le.get(re).M:null;me.bindFramebuffer(I.FRAMEBUFFER,Ae)}}},this.readRenderTargetPixelsAsync=async function(y,C,z,U,F,pe,Me,de=0){if(!(y&&y.isWebGLRenderTarget))throw new Error("THREE.WebGLRenderer.readRenderTargetPixels: renderTarget is not THREE.WebGLRenderTarget.");let Se=Le.get(y).M;if(y.isWebGLCubeRenderTarget&&Me!==void 0&&(Se=Se[Me],Array.isArray(Se)&&(Se=Se[0])),Se)if(C>=0&&C<=y.width-U&&z>=0&&z<=y.height-F){me.bindFramebuffer(I.FRAMEBUFFER,Se);let Ae=y.textures[de],Be=Ae.format,Xe=Ae.type;y.textures.length>1&&I.readBuffer(I.COLOR_ATTACHMENT0+de);let _e=Uc(Ae);if(_e.fi===!1)throw new Error("THREE.WebGLRenderer.readRenderTargetPixelsAsync: renderTarget is not in RGBA or implementation defined format.");if(_e.pi===!1)throw new Error("THREE.WebGLRenderer.readRenderTargetPixelsAsync: renderTarget is not in UnsignedByteType or implementation defined type.");let qe=I.createBuffer();I.bindBuffer(I.PIXEL_PACK_BUFFER,qe),I.bufferData(I.PIXEL_PACK_BUFFER,pe.byteLength,I.STREAM_READ),I.readPixels(C,z,U,F,ae.convert(Be),ae.convert(Xe),0),I.bindBuffer(I.PIXEL_PACK_BUFFER,null);let mt=re!==null?Le.get(re).M:null;me.bindFramebuffer(I.FRAMEBUFFER,mt);let st=I.fenceSync(I.SYNC_GPU_COMMANDS_COMPLETE,0);return I.flush(),await ru(I,st,4),I.bindBuffer(I.PIXEL_PACK_BUFFER,qe),I.getBufferSubData(I.PIXEL_PACK_BUFFER,0,pe),I.bindBuffer(I.PIXEL_PACK_BUFFER,null),I.deleteBuffer(qe),I.deleteSync(st),pe}else throw new Error("THREE.WebGLRenderer.readRenderTargetPixelsAsync: requested read bounds are out of range.")},this.copyFramebufferToTexture=function(y,C=null,z=0){let U=Math.pow(2,-z),F=Math.floor(y.image.width*U),pe=Math.floor(y.image.height*U),Me=C!==null?C.x:0,de=C!==null?C.y:0;Oe.setTexture2D(y,0),I.copyTexSubImage2D(I.TEXTURE_2D,z,0,0,Me,de,F,pe),me.unbindTexture()},this.copyTextureToTexture=function(y,C,z=null,U=null,F=0,pe=0){let Me,de,Se,Ae,Be,Xe,_e,qe,mt,st=y.isCompressedTexture?y.mipmaps[pe]:y.image;if(z!==null)Me=z.max.x-z.min.x,de=z.max.y-z.min.y,Se=z.isBox3?z.max.z-z.min.z:1,Ae=z.min.x,Be=z.min.y,Xe=z.isBox3?z.min.z:0;else{let je=Math.pow(2,-F);Me=Math.floor(st.width*je),de=Math.floor(st.height*je),y.isDataArrayTexture?Se=st.depth:y.isData3DTexture?Se=Math.floor(st.depth*je):Se=1,Ae=0,Be=0,Xe=0}U!==null?(_e=U.x,qe=U.y,mt=U.z):(_e=0,qe=0,mt=0);let it=ae.convert(C.format),Ut=ae.convert(C.type),we;C.isData3DTexture?(Oe.setTexture3D(C,0),we=I.TEXTURE_3D):C.isDataArrayTexture||C.isCompressedArrayTexture?(Oe.setTexture2DArray(C,0),we=I.TEXTURE_2D_ARRAY):(Oe.setTexture2D(C,0),we=I.TEXTURE_2D),me.activeTexture(I.TEXTURE0),me.pixelStorei(I.UNPACK_FLIP_Y_WEBGL,C.flipY),me.pixelStorei(I.UNPACK_PREMULTIPLY_ALPHA_WEBGL,C.premultiplyAlpha),me.pixelStorei(I.UNPACK_ALIGNMENT,C.unpackAlignment);let zt=me.getParameter(I.UNPACK_ROW_LENGTH),Je=me.getParameter(I.UNPACK_IMAGE_HEIGHT),bi=me.getParameter(I.UNPACK_SKIP_PIXELS),Ot=me.getParameter(I.UNPACK_SKIP_ROWS),fr=me.getParameter(I.UNPACK_SKIP_IMAGES);me.pixelStorei(I.UNPACK_ROW_LENGTH,st.width),me.pixelStorei(I.UNPACK_IMAGE_HEIGHT,st.height),me.pixelStorei(I.UNPACK_SKIP_PIXELS,Ae),me.pixelStorei(I.UNPACK_SKIP_ROWS,Be),me.pixelStorei(I.UNPACK_SKIP_IMAGES,Xe);let Qn=y.isDataArrayTexture||y.isData3DTexture,_i=C.isDataArrayTexture||C.isData3DTexture;if(y.isDepthTexture){let je=Le.get(y),Pt=Le.get(C),pn=Le.get(je.hn),ht=Le.get(Pt.hn);me.bindFramebuffer(I.READ_FRAMEBUFFER,pn.M),me.bindFramebuffer(I.DRAW_FRAMEBUFFER,ht.M);for(let Et=0;Et<Se;Et++)Qn&&(I.framebufferTextureLayer(I.READ_FRAMEBUFFER,I.COLOR_ATTACHMENT0,Le.get(y)._,F,Xe+Et),I.framebufferTextureLayer(I.DRAW_FRAMEBUFFER,I.COLOR_ATTACHMENT0,Le.get(C)._,pe,mt+Et)),I.blitFramebuffer(Ae,Be,Ae+Me,Be+de,_e,qe,_e+Me,qe+de,I.DEPTH_BUFFER_BIT,I.NEAREST);me.bindFramebuffer(I.READ_FRAMEBUFFER,null),me.bindFramebuffer(I.DRAW_FRAMEBUFFER,null)}else if(F!==0||y.isRenderTargetTexture||Le.has(y)){let je=Le.get(y),Pt=Le.get(C);me.bindFramebuffer(I.READ_FRAMEBUFFER,P),me.bindFramebuffer(I.DRAW_FRAMEBUFFER,q);for(let pn=0;pn<Se;pn++)Qn?I.framebufferTextureLayer(I.READ_FRAMEBUFFER,I.COLOR_ATTACHMENT0,je._,F,Xe+pn):I.framebufferTexture2D(I.READ_FRAMEBUFFER,I.COLOR_ATTACHMENT0,I.TEXTURE_2D,je._,F),_i?I.framebufferTextureLayer(I.DRAW_FRAMEBUFFER,I.COLOR_ATTACHMENT0,Pt._,pe,mt+pn):I.framebufferTexture2D(I.DRAW_FRAMEBUFFER,I.COLOR_ATTACHMENT0,I.TEXTURE_2D,Pt._,pe),F!==0?I.blitFramebuffer(Ae,Be,Ae+Me,Be+de,_e,qe,_e+Me,qe+de,I.COLOR_BUFFER_BIT,I.NEAREST):_i?I.copyTexSubImage3D(we,pe,_e,qe,mt+pn,Ae,Be,Me,de):I.copyTexSubImage2D(we,pe,_e,qe,Ae,Be,Me,de);me.bindFramebuffer(I.READ_FRAMEBUFFER,null),me.bindFramebuffer(I.DRAW_FRAMEBUFFER,null)}else _i?y.isDataTexture||y.isData3DTexture?I.texSubImage3D(we,pe,_e,qe,mt,Me,de,Se,it,Ut,st.data):C.isCompressedArrayTexture?I.compressedTexSubImage3D(we,pe,_e,qe,mt,Me,de,Se,it,st.data):I.texSubImage3D(we,pe,_e,qe,mt,Me,de,Se,it,Ut,st):y.isDataTexture?I.texSubImage2D(I.TEXTURE_2D,pe,_e,qe,Me,de,it,Ut,st.data):y.isCompressedTexture?I.compressedTexSubImage2D(I.TEXTURE_2D,pe,_e,qe,st.width,st.height,it,st.data):I.texSubImage2D(I.TEXTURE_2D,pe,_e,qe,Me,de,it,Ut,st);me.pixelStorei(I.UNPACK_ROW_LENGTH,zt),me.pixelStorei(I.UNPACK_IMAGE_HEIGHT,Je),me.pixelStorei(I.UNPACK_SKIP_PIXELS,bi),me.pixelStorei(I.UNPACK_SKIP_ROWS,Ot),me.pixelStorei(I.UNPACK_SKIP_IMAGES,fr),pe===0&&C.generateMipmaps===!0&&C.mipmapsAutoUpdate===!0&&I.generateMipmap(we),me.unbindTexture()},this.initRenderTarget=function(y){Le.get(y).M===void 0&&Oe.setupRenderTarget(y)},this.initTexture=function(y){y.isCubeTexture?Oe.setTextureCube(y,0):y.isData3DTexture?Oe.setTexture3D(y,0):y.isDataArrayTexture||y.isCompressedArrayTexture?Oe.setTexture2DArray(y,0):Oe.setTexture2D(y,0),me.unbindTexture()},this.resetState=function(){K=0,V=0,re=null,me.reset(),ce.reset()}}get coordinateSystem(){return hn}get outputColorSpace(){return this.di}set outputColorSpace(e){this.di=e;let t=this.getContext();t.drawingBufferColorSpace=Ye.Fi(e),t.unpackColorSpace=Ye.Bi()}};function qv(i){return 10**Math.floor(Math.log10(Math.max(i[0],i[1],1e-12)*.9))}function Xu(i,e){let t=qv(i),n=(Math.ceil(Math.max(i[0],i[1])*.75/t)+1)*t,s=-i[2]/2-Math.max(...i)*.001,r=[];for(let l=-n;l<=n+t/2;l+=t)r.push(l,-n,s,l,n,s,-n,l,s,n,l,s);let o=new It;o.setAttribute("position",new ut(Float32Array.from(r),3));let a=new zs(o,new rs({color:e,transparent:!0,opacity:.45}));return a.frustumCulled=!1,a}var qu={type:"change"},rc={type:"start"},$u={type:"end"},xa=new ui,Yu=new Qt,Yv=Math.cos(70*Hl.DEG2RAD),Mt=new N,Zt=2*Math.PI,Ke={NONE:-1,ROTATE:0,DOLLY:1,PAN:2,TOUCH_ROTATE:3,TOUCH_PAN:4,TOUCH_DOLLY_PAN:5,TOUCH_DOLLY_ROTATE:6},sc=1e-6,ya=class extends $s{constructor(e,t=null){super(e,t),this.state=Ke.NONE,this.target=new N,this.cursor=new N,this.minDistance=0,this.maxDistance=1/0,this.minZoom=0,this.maxZoom=1/0,this.minTargetRadius=0,this.maxTargetRadius=1/0,this.minPolarAngle=0,this.maxPolarAngle=Math.PI,this.minAzimuthAngle=-1/0,this.maxAzimuthAngle=1/0,this.enableDamping=!1,this.dampingFactor=.05,this.enableZoom=!0,this.zoomSpeed=1,this.enableRotate=!0,this.rotateSpeed=1,this.keyRotateSpeed=1,this.enablePan=!0,this.panSpeed=1,this.screenSpacePanning=!0,this.keyPanSpeed=7,this.zoomToCursor=!1,this.autoRotate=!1,this.autoRotateSpeed=2,this.keys={LEFT:"ArrowLeft",UP:"ArrowUp",RIGHT:"ArrowRight",BOTTOM:"ArrowDown"},this.mouseButtons={LEFT:gi.ROTATE,MIDDLE:gi.DOLLY,RIGHT:gi.PAN},this.touches={ONE:vi.ROTATE,TWO:vi.DOLLY_PAN},this.target0=this.target.clone(),this.position0=this.object.position.clone(),this.zoom0=this.object.zoom,this.Pt="auto",this.Lt=null,this.mi=new N,this.gi=new en,this.vi=new N,this.xi=new en().setFromUnitVectors(e.up,new N(0,1,0)),this.Gs=this.xi.clone().invert(),this.C=new ls,this.oe=new ls,this._e=1,this.ke=new N,this.we=new De,this.Ee=new De,this.ze=new De,this.Ae=new De,this.Te=new De,this.Ge=new De,this.Ve=new De,this.He=new De,this.Re=new De,this.pn=new N,this.ee=new De,this.mt=!1,this.D=[],this.We={},this.It=!1,this.mn=Zv.bind(this),this.yi=$v.bind(this),this.gt=jv.bind(this),this.Si=ix.bind(this),this.Mi=Qv.bind(this),this.bi=ex.bind(this),this._i=tx.bind(this),this.Vs=nx.bind(this),this.Hs=Jv.bind(this),this.Ws=Kv.bind(this),this.wi=sx.bind(this),this.gn=rx.bind(this),this.domElement!==null&&this.connect(this.domElement),this.update()}set cursorStyle(e){this.Pt=e,e==="grab"?this.domElement.style.cursor="grab":this.domElement.style.cursor="auto"}get cursorStyle(){return this.Pt}connect(e){super.connect(e),this.domElement.addEventListener("pointerdown",this.yi),this.domElement.addEventListener("pointercancel",this.gt),this.domElement.addEventListener("contextmenu",this.Si),this.domElement.addEventListener("wheel",this.Mi,{passive:!1}),this.domElement.ownerDocument.addEventListener("keydown",this.wi,{passive:!0,capture:!0}),this.domElement.style.touchAction="none"}disconnect(){this.state=Ke.NONE,this.domElement.removeEventListener("pointerdown",this.yi),this.domElement.ownerDocument.removeEventListener("pointermove",this.mn),this.domElement.ownerDocument.removeEventListener("pointerup",this.gt),this.domElement.removeEventListener("pointercancel",this.gt),this.domElement.removeEventListener("wheel",this.Mi),this.domElement.removeEventListener("contextmenu",this.Si),this.stopListenToKeyEvents(),this.domElement.ownerDocument.removeEventListener("keydown",this.wi,{capture:!0}),this.domElement.ownerDocument.removeEventListener("keyup",this.gn,{capture:!0}),this.It=!1,this.D.length=0,this.We={},this.domElement.style.touchAction="",this.domElement.style.cursor="auto"}dispose(){this.disconnect()}getPolarAngle(){return this.C.phi}getAzimuthalAngle(){return this.C.theta}getDistance(){return this.object.position.distanceTo(this.target)}listenToKeyEvents(e){e.addEventListener("keydown",this.bi),this.Lt=e}stopListenToKeyEvents(){this.Lt!==null&&(this.Lt.removeEventListener("keydown",this.bi),this.Lt=null)}saveState(){this.target0.copy(this.target),this.position0.copy(this.object.position),this.zoom0=this.object.zoom}reset(){this.target.copy(this.target0),this.object.position.copy(this.position0),this.object.zoom=this.zoom0,this.object.updateProjectionMatrix(),this.dispatchEvent(qu),this.update(),this.state=Ke.NONE}pan(e,t){this.Ce(e,t),this.update()}dollyIn(e){this.vn(e),this.update()}dollyOut(e){this.Nt(e),this.update()}rotateLeft(e){this.Xe(e),this.update()}rotateUp(e){this.vt(e),this.update()}update(e=null){let t=this.object.position;Mt.copy(t).sub(this.target),Mt.applyQuaternion(this.xi),this.C.setFromVector3(Mt),this.autoRotate&&this.state===Ke.NONE&&this.Xe(this.Xs(e)),this.enableDamping?(this.C.theta+=this.oe.theta*this.dampingFactor,this.C.phi+=this.oe.phi*this.dampingFactor):(this.C.theta+=this.oe.theta,this.C.phi+=this.oe.phi);let n=this.minAzimuthAngle,s=this.maxAzimuthAngle;isFinite(n)&&isFinite(s)&&(n<-Math.PI?n+=Zt:n>Math.PI&&(n-=Zt),s<-Math.PI?s+=Zt:s>Math.PI&&(s-=Zt),n<=s?this.C.theta=Math.max(n,Math.min(s,this.C.theta)):this.C.theta=this.C.theta>(n+s)/2?Math.max(n,this.C.theta):Math.min(s,this.C.theta)),this.C.phi=Math.max(this.minPolarAngle,Math.min(this.maxPolarAngle,this.C.phi)),this.C.makeSafe(),this.enableDamping===!0?this.target.addScaledVector(this.ke,this.dampingFactor):this.target.add(this.ke),this.target.sub(this.cursor),this.target.clampLength(this.minTargetRadius,this.maxTargetRadius),this.target.add(this.cursor);let r=!1;if(this.zoomToCursor&&this.mt||this.object.isOrthographicCamera)this.C.radius=this.xn(this.C.radius);else{let o=this.C.radius;this.C.radius=this.xn(this.C.radius*this._e),r=o!=this.C.radius}if(Mt.setFromSpherical(this.C),Mt.applyQuaternion(this.Gs),t.copy(this.target).add(Mt),this.object.lookAt(this.target),this.enableDamping===!0?(this.oe.theta*=1-this.dampingFactor,this.oe.phi*=1-this.dampingFactor,this.ke.multiplyScalar(1-this.dampingFactor)):(this.oe.set(0,0,0),this.ke.set(0,0,0)),this.zoomToCursor&&this.mt){let o=null;if(this.object.isPerspectiveCamera){let a=Mt.length();o=this.xn(a*this._e);let l=a-o;this.object.position.addScaledVector(this.pn,l),this.object.updateMatrixWorld(),r=!!l}else if(this.object.isOrthographicCamera){let a=new N(this.ee.x,this.ee.y,0);a.unproject(this.object);let l=this.object.zoom;this.object.zoom=Math.max(this.minZoom,Math.min(this.maxZoom,this.object.zoom/this._e)),this.object.updateProjectionMatrix(),r=l!==this.object.zoom;let c=new N(this.ee.x,this.ee.y,0);c.unproject(this.object),this.object.position.sub(c).add(a),this.object.updateMatrixWorld(),o=Mt.length()}else console.warn("WARNING: OrbitControls.js encountered an unknown camera type - zoom to cursor disabled."),this.zoomToCursor=!1;o!==null&&(this.screenSpacePanning?this.target.set(0,0,-1).transformDirection(this.object.matrix).multiplyScalar(o).add(this.object.position):(xa.origin.copy(this.object.position),xa.direction.set(0,0,-1).transformDirection(this.object.matrix),Math.abs(this.object.up.dot(xa.direction))<Yv?this.object.lookAt(this.target):(Yu.setFromNormalAndCoplanarPoint(this.object.up,this.target),xa.intersectPlane(Yu,this.target))))}else if(this.object.isOrthographicCamera){let o=this.object.zoom;this.object.zoom=Math.max(this.minZoom,Math.min(this.maxZoom,this.object.zoom/this._e)),o!==this.object.zoom&&(this.object.updateProjectionMatrix(),r=!0)}return this._e=1,this.mt=!1,r||this.mi.distanceToSquared(this.object.position)>sc||8*(1-this.gi.dot(this.object.quaternion))>sc||this.vi.distanceToSquared(this.target)>sc?(this.dispatchEvent(qu),this.mi.copy(this.object.position),this.gi.copy(this.object.quaternion),this.vi.copy(this.target),!0):!1}Xs(e){return e!==null?Zt/60*this.autoRotateSpeed*e:Zt/60/60*this.autoRotateSpeed}Dt(e){let t=Math.abs(e*.01);return Math.pow(.95,this.zoomSpeed*t)}Xe(e){this.oe.theta-=e}vt(e){this.oe.phi-=e}Ei(e,t){Mt.setFromMatrixColumn(t,0),Mt.multiplyScalar(-e),this.ke.add(Mt)}Ai(e,t){this.screenSpacePanning===!0?Mt.setFromMatrixColumn(t,1):(Mt.setFromMatrixColumn(t,0),Mt.crossVectors(this.object.up,Mt)),Mt.multiplyScalar(e),this.ke.add(Mt)}Ce(e,t){let n=this.domElement;if(this.object.isPerspectiveCamera){let s=this.object.position;Mt.copy(s).sub(this.target);let r=Mt.length();r*=Math.tan(this.object.fov/2*Math.PI/180),this.Ei(2*e*r/n.clientHeight,this.object.matrix),this.Ai(2*t*r/n.clientHeight,this.object.matrix)}else this.object.isOrthographicCamera?(this.Ei(e*(this.object.right-this.object.left)/this.object.zoom/n.clientWidth,this.object.matrix),this.Ai(t*(this.object.top-this.object.bottom)/this.object.zoom/n.clientHeight,this.object.matrix)):(console.warn("WARNING: OrbitControls.js encountered an unknown camera type - pan disabled."),this.enablePan=!1)}Nt(e){this.object.isPerspectiveCamera||this.object.isOrthographicCamera?this._e/=e:(console.warn("WARNING: OrbitControls.js encountered an unknown camera type - dolly/zoom disabled."),this.enableZoom=!1)}vn(e){this.object.isPerspectiveCamera||this.object.isOrthographicCamera?this._e*=e:(console.warn("WARNING: OrbitControls.js encountered an unknown camera type - dolly/zoom disabled."),this.enableZoom=!1)}yn(e,t){if(!this.zoomToCursor)return;this.mt=!0;let n=this.domElement.getBoundingClientRect(),s=e-n.left,r=t-n.top,o=n.width,a=n.height;this.ee.x=s/o*2-1,this.ee.y=-(r/a)*2+1,this.pn.set(this.ee.x,this.ee.y,1).unproject(this.object).sub(this.object.position).normalize()}xn(e){return Math.max(this.minDistance,Math.min(this.maxDistance,e))}Ti(e){this.we.set(e.clientX,e.clientY)}qs(e){this.yn(e.clientX,e.clientY),this.Ve.set(e.clientX,e.clientY)}Ri(e){this.Ae.set(e.clientX,e.clientY)}Ys(e){this.Ee.set(e.clientX,e.clientY),this.ze.subVectors(this.Ee,this.we).multiplyScalar(this.rotateSpeed);let t=this.domElement;this.Xe(Zt*this.ze.x/t.clientHeight),this.vt(Zt*this.ze.y/t.clientHeight),this.we.copy(this.Ee),this.update()}$s(e){this.He.set(e.clientX,e.clientY),this.Re.subVectors(this.He,this.Ve),this.Re.y>0?this.Nt(this.Dt(this.Re.y)):this.Re.y<0&&this.vn(this.Dt(this.Re.y)),this.Ve.copy(this.He),this.zoomToCursor&&(this.mt=!0,this.pn.set(this.ee.x,this.ee.y,1).unproject(this.object).sub(this.object.position).normalize()),this.update()}Zs(e){this.Te.set(e.clientX,e.clientY),this.Ge.subVectors(this.Te,this.Ae).multiplyScalar(this.panSpeed),this.Ce(this.Ge.x,this.Ge.y),this.Ae.copy(this.Te),this.update()}js(e){this.yn(e.clientX,e.clientY),e.deltaY<0?this.vn(this.Dt(e.deltaY)):e.deltaY>0&&this.Nt(this.Dt(e.deltaY)),this.update()}Js(e){let t=!1;switch(e.code){case this.keys.UP:e.ctrlKey||e.metaKey||e.shiftKey?this.enableRotate&&this.vt(Zt*this.keyRotateSpeed/this.domElement.clientHeight):this.enablePan&&this.Ce(0,this.keyPanSpeed),t=!0;break;case this.keys.BOTTOM:e.ctrlKey||e.metaKey||e.shiftKey?this.enableRotate&&this.vt(-Zt*this.keyRotateSpeed/this.domElement.clientHeight):this.enablePan&&this.Ce(0,-this.keyPanSpeed),t=!0;break;case this.keys.LEFT:e.ctrlKey||e.metaKey||e.shiftKey?this.enableRotate&&this.Xe(Zt*this.keyRotateSpeed/this.domElement.clientHeight):this.enablePan&&this.Ce(this.keyPanSpeed,0),t=!0;break;case this.keys.RIGHT:e.ctrlKey||e.metaKey||e.shiftKey?this.enableRotate&&this.Xe(-Zt*this.keyRotateSpeed/this.domElement.clientHeight):this.enablePan&&this.Ce(-this.keyPanSpeed,0),t=!0;break}t&&(e.preventDefault(),this.update())}Ci(e){if(this.D.length===1)this.we.set(e.pageX,e.pageY);else{let t=this.qe(e),n=.5*(e.pageX+t.x),s=.5*(e.pageY+t.y);this.we.set(n,s)}}Pi(e){if(this.D.length===1)this.Ae.set(e.pageX,e.pageY);else{let t=this.qe(e),n=.5*(e.pageX+t.x),s=.5*(e.pageY+t.y);this.Ae.set(n,s)}}Li(e){let t=this.qe(e),n=e.pageX-t.x,s=e.pageY-t.y,r=Math.sqrt(n*n+s*s);this.Ve.set(0,r)}Ks(e){this.enableZoom&&this.Li(e),this.enablePan&&this.Pi(e)}Qs(e){this.enableZoom&&this.Li(e),this.enableRotate&&this.Ci(e)}Ii(e){if(this.D.length==1)this.Ee.set(e.pageX,e.pageY);else{let n=this.qe(e),s=.5*(e.pageX+n.x),r=.5*(e.pageY+n.y);this.Ee.set(s,r)}this.ze.subVectors(this.Ee,this.we).multiplyScalar(this.rotateSpeed);let t=this.domElement;this.Xe(Zt*this.ze.x/t.clientHeight),this.vt(Zt*this.ze.y/t.clientHeight),this.we.copy(this.Ee)}Ni(e){if(this.D.length===1)this.Te.set(e.pageX,e.pageY);else{let t=this.qe(e),n=.5*(e.pageX+t.x),s=.5*(e.pageY+t.y);this.Te.set(n,s)}this.Ge.subVectors(this.Te,this.Ae).multiplyScalar(this.panSpeed),this.Ce(this.Ge.x,this.Ge.y),this.Ae.copy(this.Te)}Di(e){let t=this.qe(e),n=e.pageX-t.x,s=e.pageY-t.y,r=Math.sqrt(n*n+s*s);this.He.set(0,r),this.Re.set(0,Math.pow(this.He.y/this.Ve.y,this.zoomSpeed)),this.Nt(this.Re.y),this.Ve.copy(this.He);let o=(e.pageX+t.x)*.5,a=(e.pageY+t.y)*.5;this.yn(o,a)}er(e){this.enableZoom&&this.Di(e),this.enablePan&&this.Ni(e)}tr(e){this.enableZoom&&this.Di(e),this.enableRotate&&this.Ii(e)}nr(e){this.D.push(e.pointerId)}ir(e){delete this.We[e.pointerId];for(let t=0;t<this.D.length;t++)if(this.D[t]==e.pointerId){this.D.splice(t,1);return}}sr(e){for(let t=0;t<this.D.length;t++)if(this.D[t]==e.pointerId)return!0;return!1}Ui(e){let t=this.We[e.pointerId];t===void 0&&(t=new De,this.We[e.pointerId]=t),t.set(e.pageX,e.pageY)}qe(e){let t=e.pointerId===this.D[0]?this.D[1]:this.D[0];return this.We[t]}rr(e){let t=e.deltaMode,n={clientX:e.clientX,clientY:e.clientY,deltaY:e.deltaY};switch(t){case 1:n.deltaY*=16;break;case 2:n.deltaY*=100;break}return e.ctrlKey&&!this.It&&(n.deltaY*=10),n}};function $v(i){this.enabled!==!1&&(this.D.length===0&&(this.domElement.setPointerCapture(i.pointerId),this.domElement.ownerDocument.addEventListener("pointermove",this.mn),this.domElement.ownerDocument.addEventListener("pointerup",this.gt)),!this.sr(i)&&(this.nr(i),i.pointerType==="touch"?this._i(i):this.Hs(i),this.Pt==="grab"&&(this.domElement.style.cursor="grabbing")))}function Zv(i){this.enabled!==!1&&(i.pointerType==="touch"?this.Vs(i):this.Ws(i))}function jv(i){switch(this.ir(i),this.D.length){case 0:this.domElement.releasePointerCapture(i.pointerId),this.domElement.ownerDocument.removeEventListener("pointermove",this.mn),this.domElement.ownerDocument.removeEventListener("pointerup",this.gt),this.dispatchEvent($u),this.state=Ke.NONE,this.Pt==="grab"&&(this.domElement.style.cursor="grab");break;case 1:let e=this.D[0],t=this.We[e];this._i({pointerId:e,pageX:t.x,pageY:t.y});break}}function Jv(i){let e;switch(i.button){case 0:e=this.mouseButtons.LEFT;break;case 1:e=this.mouseButtons.MIDDLE;break;case 2:e=this.mouseButtons.RIGHT;break;default:e=-1}switch(e){case gi.DOLLY:if(this.enableZoom===!1)return;this.qs(i),this.state=Ke.DOLLY;break;case gi.ROTATE:if(i.ctrlKey||i.metaKey||i.shiftKey){if(this.enablePan===!1)return;this.Ri(i),this.state=Ke.PAN}else{if(this.enableRotate===!1)return;this.Ti(i),this.state=Ke.ROTATE}break;case gi.PAN:if(i.ctrlKey||i.metaKey||i.shiftKey){if(this.enableRotate===!1)return;this.Ti(i),this.state=Ke.ROTATE}else{if(this.enablePan===!1)return;this.Ri(i),this.state=Ke.PAN}break;default:this.state=Ke.NONE}this.state!==Ke.NONE&&this.dispatchEvent(rc)}function Kv(i){switch(this.state){case Ke.ROTATE:if(this.enableRotate===!1)return;this.Ys(i);break;case Ke.DOLLY:if(this.enableZoom===!1)return;this.$s(i);break;case Ke.PAN:if(this.enablePan===!1)return;this.Zs(i);break}}function Qv(i){this.enabled===!1||this.enableZoom===!1||this.state!==Ke.NONE||(i.preventDefault(),this.dispatchEvent(rc),this.js(this.rr(i)),this.dispatchEvent($u))}function ex(i){this.enabled!==!1&&this.Js(i)}function tx(i){switch(this.Ui(i),this.D.length){case 1:switch(this.touches.ONE){case vi.ROTATE:if(this.enableRotate===!1){this.state=Ke.NONE;break}this.Ci(i),this.state=Ke.TOUCH_ROTATE;break;case vi.PAN:if(this.enablePan===!1){this.state=Ke.NONE;break}this.Pi(i),this.state=Ke.TOUCH_PAN;break;default:this.state=Ke.NONE}break;case 2:switch(this.touches.TWO){case vi.DOLLY_PAN:if(this.enableZoom===!1&&this.enablePan===!1)return;this.Ks(i),this.state=Ke.TOUCH_DOLLY_PAN;break;case vi.DOLLY_ROTATE:if(this.enableZoom===!1&&this.enableRotate===!1)return;this.Qs(i),this.state=Ke.TOUCH_DOLLY_ROTATE;break;default:this.state=Ke.NONE}break;default:this.state=Ke.NONE}this.state!==Ke.NONE&&this.dispatchEvent(rc)}function nx(i){switch(this.Ui(i),this.state){case Ke.TOUCH_ROTATE:if(this.enableRotate===!1)return;this.Ii(i),this.update();break;case Ke.TOUCH_PAN:if(this.enablePan===!1)return;this.Ni(i),this.update();break;case Ke.TOUCH_DOLLY_PAN:if(this.enableZoom===!1&&this.enablePan===!1)return;this.er(i),this.update();break;case Ke.TOUCH_DOLLY_ROTATE:if(this.enableZoom===!1&&this.enableRotate===!1)return;this.tr(i),this.update();break;default:this.state=Ke.NONE}}function ix(i){this.enabled!==!1&&i.preventDefault()}function sx(i){i.key==="Control"&&(this.It=!0,this.domElement.ownerDocument.addEventListener("keyup",this.gn,{passive:!0,capture:!0}))}function rx(i){i.key==="Control"&&(this.It=!1,this.domElement.ownerDocument.removeEventListener("keyup",this.gn,{passive:!0,capture:!0}))}var ox={front:[0,-1,0],back:[0,1,0],left:[-1,0,0],right:[1,0,0],top:[0,-1e-4,1],bottom:[0,-1e-4,-1],iso:[.62,-.95,.62]},ax=350,Zu=Math.PI/18,lx=()=>matchMedia("(prefers-reduced-motion: reduce)").matches,Sa=class{constructor(e,{moved:t,held:n}){this.changed=t,this.camera=new Gt(35,1,.1,1e3),this.camera.up.set(0,0,1),this.controls=new ya(this.camera,e),this.controls.zoomToCursor=!0,this.controls.addEventListener("change",()=>this.moved()),this.controls.addEventListener("start",()=>n(!0)),this.controls.addEventListener("end",()=>n(!1)),this.radius=1}moved(){let e=this.camera.position.distanceTo(this.controls.target);this.camera.near=Math.max(e-this.radius*3,e/200),this.camera.far=e+this.radius*6,this.camera.updateProjectionMatrix(),this.changed()}setScene(e){this.radius=e,this.controls.minDistance=e*.002,this.controls.maxDistance=e*20,this.look("iso",!1)}distanceFor(e){let t=this.camera.fov*Math.PI/360,n=Math.atan(Math.tan(t)*Math.min(1,this.camera.aspect));return e*1.02/Math.sin(n)}look(e,t=!0){this.isAtPlace=!1,this.go(new N,new N(...ox[e]),this.distanceFor(this.radius),t)}fit(){this.isAtPlace=!1,this.go(new N,this.direction(),this.distanceFor(this.radius))}comeBack(){this.camera.updateMatrixWorld();let{planes:e}=new Wn().setFromProjectionMatrix(this.camera.projectionMatrix.clone().multiply(this.camera.matrixWorldInverse));Math.min(...e.map(({constant:n})=>n))<this.radius*(this.isAtPlace?1:-1)&&this.fit()}direction(){return this.camera.position.clone().sub(this.controls.target).normalize()}fly(e,t,n){let s=t.length()>Math.min(.1,this.radius*.01)?t.clone().normalize():this.direction();s.add(this.direction().multiplyScalar(.35)).normalize(),this.isAtPlace=!0;let r=Math.min(this.radius*.04,n>0?n*100:1/0);this.go(e,s,this.distanceFor(Math.min(this.radius,Math.max(n*2.5,r))))}go(e,t,n,s=!0){let r=e.clone().add(t.clone().normalize().multiplyScalar(n));if(cancelAnimationFrame(this.flight),!s||lx())return this.stand(e,r);let[o,a]=[this.controls.target.clone(),this.camera.position.clone()],l=performance.now(),c=h=>{let d=Math.min(1,Math.max(0,(h-l)/ax)),u=d*d*(3-2*d);this.stand(o.clone().lerp(e,u),a.clone().lerp(r,u)),d<1&&(this.flight=requestAnimationFrame(c))};this.flight=requestAnimationFrame(c)}stand(e,t){this.controls.target.copy(e),this.camera.position.copy(t),this.controls.update(),this.moved()}turn(e,t){let n=this.camera.position.clone().sub(this.controls.target);n.applyAxisAngle(new N(0,0,1),e*Zu);let s=new N().crossVectors(this.camera.up,n).normalize(),r=n.clone().applyAxisAngle(s,-t*Zu);Math.abs(r.z)<r.length()*.999&&n.copy(r),this.stand(this.controls.target.clone(),this.controls.target.clone().add(n))}zoom(e){let t=this.camera.position.clone().sub(this.controls.target).multiplyScalar(e);this.stand(this.controls.target.clone(),this.controls.target.clone().add(t))}};var Ku=`
uniform mat4 modelViewMatrix;
uniform mat4 projectionMatrix;
uniform vec2 pixels;
uniform float width;
out vec3 place;`,cx=`${Ku}
in vec3 position;
in vec3 to;
vec4 clip(vec3 at) {
  vec4 view = modelViewMatrix * vec4(at, 1.0);
  view.xyz *= 0.9985; // in front of the surface that it lies on
  return projectionMatrix * view;
}
void main() {
  int number = gl_VertexID % 4;
  vec2 corner = vec2(number == 1 || number == 2, number < 2 ? -1.0 : 1.0);
  vec4 a = clip(position);
  vec4 b = clip(to);
  place = mix(position, to, corner.x);
  float least = 0.01 * projectionMatrix[3][2] / (projectionMatrix[2][2] - 1.0); // of the way to what is near
  if (a.w < least || b.w < least) { gl_Position = vec4(2.0, 2.0, 2.0, 1.0); return; }
  vec2 along = (b.xy / b.w - a.xy / a.w) * pixels;
  float size = length(along);
  vec2 unit = size > 0.0001 ? along / size : vec2(1.0, 0.0);
  vec4 end = mix(a, b, corner.x);
  vec2 aside = vec2(-unit.y, unit.x) * corner.y + unit * (corner.x - 0.5);
  end.xy += aside * width / pixels * end.w;
  gl_Position = end;
}`,ju=`${Ku}
in vec3 position;
void main() {
  place = position;
  vec4 view = modelViewMatrix * vec4(position, 1.0);
  view.xyz *= 0.999;
  gl_Position = projectionMatrix * view;
  gl_PointSize = width;
}`,hx=`
precision highp float;
uniform vec3 tint;
uniform float opacity;
uniform bool isPoint, isCut;
uniform vec4 plane;
in vec3 place;
out vec4 color;
void main() {
  if (isCut && dot(plane.xyz, place) > plane.w) discard;
  if (isPoint && distance(gl_PointCoord, vec2(0.5)) > 0.5) discard;
  color = vec4(tint, opacity);
}`;function Qu({segments:i,faces:e,points:t},n,s,r=1){let o=new un,a=new un;o.add(a),o.hidden=a;let l=(c,h,d,u)=>{h.boundingSphere=new dn;for(let[f,v]of[[!0,u.opacity],[!1,u.opacity*.22]]){let S={...s,tint:{value:wn(n)},width:{value:u.width},opacity:{value:v},isPoint:{value:!!u.isPoint}},m=new di({vertexShader:d,fragmentShader:hx,uniforms:S,glslVersion:Di,side:Wt,transparent:!0,depthTest:f,depthWrite:!1}),p=new c(h,m);p.frustumCulled=!1,p.renderOrder=f?2:1,(f?o:a).add(p)}};return e?.length&&l(Ht,Ju(e),ju,{opacity:.4*r+.05,width:1}),i?.length&&l(Ht,ux(i),cx,{opacity:.95,width:1.6+1.6*r}),t?.length&&l(Gs,Ju(t),ju,{opacity:.95,width:5+4*r,isPoint:!0}),o}function Ju(i){let e=new It;return e.setAttribute("position",new ut(Float32Array.from(i),3)),e}function ux(i){let e=i.length/6,[t,n]=[new Float32Array(e*12),new Float32Array(e*12)],s=new Uint32Array(e*6);for(let o=0;o<e;o+=1){for(let a=0;a<12;a+=1)t[o*12+a]=i[o*6+a%3],n[o*12+a]=i[o*6+3+a%3];for(let a=0;a<6;a+=1)s[o*6+a]=o*4+[0,1,2,0,2,3][a]}let r=new It;return r.setAttribute("position",new ut(t,3)),r.setAttribute("to",new ut(n,3)),r.setIndex(new ut(s,1)),r}function oc(i){i?.traverse(e=>{e.geometry?.dispose(),e.material?.dispose()}),i?.removeFromParent()}var ar=255,dx={plain:0,kept:1,deviation:2,thickness:2,file:3},fx=`
uniform mat4 modelViewMatrix;
uniform mat4 projectionMatrix;
uniform mat3 normalMatrix;
in vec3 position;
in vec4 normal;
out vec3 seen;
out vec3 turned;
out vec3 place;
#ifdef COLORED
in vec4 tint;
out vec4 own;
#endif
#ifndef COARSE
in float value;
out vec3 share;
out float shown;
#endif
void main() {
#ifndef COARSE
  int corner = gl_VertexID % 3;
  share = vec3(corner == 0, corner == 1, corner == 2);
  shown = value;
#endif
#ifdef COLORED
  own = tint;
#endif
  place = position;
  turned = normalMatrix * normal.xyz;
  vec4 view = modelViewMatrix * vec4(position, 1.0);
  seen = view.xyz;
  gl_Position = projectionMatrix * view;
}`,px=`
precision highp float;
uniform vec3 base, fresh, back, cut, edge;
uniform vec3 ramp[4];
uniform vec4 plane;
uniform int mode;
uniform bool isSmooth, hasEdges, hasBacks, isCut;
in vec3 seen, turned, place;
#ifdef COLORED
in vec4 own;
#endif
#ifndef COARSE
in vec3 share;
in float shown;
#endif
out vec4 color;

vec3 ofRamp(float t) {
  t = clamp(t, 0.0, 1.0) * 3.0;
  if (t < 1.0) return mix(ramp[0], ramp[1], t);
  return t < 2.0 ? mix(ramp[1], ramp[2], t - 1.0) : mix(ramp[2], ramp[3], t - 2.0);
}

void main() {
  if (isCut && dot(plane.xyz, place) > plane.w) discard;
#ifdef ONLY_BACKS
  bool isBack = true; // the library turns what is in front for such a material
#else
  bool isBack = !gl_FrontFacing;
#endif
  // What is seen through a section from behind lies inside of the part: the place where it is cut.
  if (isCut && isBack) {
    float stripe = step(0.5, fract((gl_FragCoord.x + gl_FragCoord.y) / 9.0));
    color = vec4(mix(cut, cut * 1.12, stripe), 1.0);
    return;
  }
  vec3 tint = base;
#ifdef COLORED
  // Between a corner with a colour and one without, as much of it as there is.
  if (mode == 3) tint = mix(base, own.rgb / max(own.a, 0.001), own.a);
#endif
#ifdef COARSE
  vec3 n = normalize(turned);
  if (dot(n, seen) > 0.0) n = -n;
#else
  vec3 flatNormal = normalize(cross(dFdx(seen), dFdy(seen)));
  vec3 n = isSmooth && length(turned) > 0.1 ? normalize(turned) : flatNormal;
  if (dot(n, seen) > 0.0 && (isBack || !isSmooth)) n = -n;
  if (mode == 1 && shown < 0.5) tint = fresh;
  if (mode == 2 && shown < 0.999) tint = ofRamp(shown * 255.0 / 254.0);
#endif
  // In a map red is a figure.
  if (isBack && hasBacks) tint = mode == 2 ? base * 0.6 : back;
  float key = max(dot(n, normalize(vec3(-0.35, 0.55, 0.75))), 0.0);
  float rim = max(dot(n, normalize(vec3(0.6, -0.3, 0.5))), 0.0);
  vec3 lit = tint * (0.5 + 0.5 * key + 0.22 * rim);
  lit += 0.10 * pow(max(dot(reflect(normalize(seen), n), normalize(vec3(-0.35, 0.55, 0.75))), 0.0), 24.0);
#ifndef COARSE
  if (hasEdges) {
    vec3 width = fwidth(share);
    vec3 near = smoothstep(width * 0.2, width * 1.1, share);
    lit = mix(edge, lit, 0.45 + 0.55 * min(near.x, min(near.y, near.z)));
  }
#endif
  color = vec4(lit, 1.0);
}`;function ac(i){let e={base:{value:[1,1,1]},fresh:{value:[0,1,0]},back:{value:[1,0,0]},cut:{value:[0,0,0]},edge:{value:[0,0,0]},ramp:{value:Zc.map(s=>new N(...wn(s)))},plane:{value:[0,0,1,0]},mode:{value:0},isSmooth:{value:!1},hasEdges:{value:!1},hasBacks:{value:!0},isCut:{value:!1}},t=({defines:s,...r})=>new di({vertexShader:fx,fragmentShader:px,uniforms:e,glslVersion:Di,defines:{...s,...i?{COLORED:""}:{}},...r}),n={side:Nt,defines:{ONLY_BACKS:""},polygonOffset:!0,polygonOffsetFactor:1,polygonOffsetUnits:8};return{uniforms:e,sides:[t({side:Rn}),t(n)],both:[t({side:Wt})],coarse:[t({side:Wt,defines:{COARSE:""}})]}}function lc({positions:i,normals:e,colors:t,index:n},s){let r=new It;r.setAttribute("position",new ut(i,3)),r.setAttribute("normal",new ut(e,4,!0)),t&&r.setAttribute("tint",new ut(t,4,!0)),n?r.setIndex(new ut(n,1)):r.setAttribute("value",new ut(new Uint8Array(i.length/3).fill(ar),1,!0)),r.boundingSphere=new dn(new N,1);let o=new un;for(let a of s){let l=new Ht(r,a);l.frustumCulled=!1,o.add(l)}return o.geometry=r,o}function ed(i,e){let t=i.geometry.getAttribute("value");e?t.array.set(e):t.array.fill(ar),t.needsUpdate=!0}var td=i=>dx[i];var nd=45,mx=160,lr=[{copy:null,pixels:1},{copy:0,pixels:1},{copy:1,pixels:1},{copy:1,pixels:.6},{copy:1,pixels:.4}],id=[12e4,16e3],gx=3e5,Ma=class{constructor(e,{onDrawn:t,onEased:n}){this.canvas=e,this.onDrawn=t,this.onEased=n,this.easing=0,this.isSoftware=vx(),this.renderer=new ma({canvas:e,antialias:!this.isSoftware,alpha:!0,powerPreference:"high-performance"}),this.camera=new Sa(e,{moved:()=>this.moved(),held:s=>this.hold(s)}),this.shared={pixels:{value:new De(1,1)},isCut:{value:!1},plane:{value:[0,0,1,0]}},this.sides={before:this.side(),after:this.side()},this.settings={arrangement:"before",divider:.5,colors:"plain",smooth:!1,edges:!1,backs:!0,grid:!0},this.themeName="light",this.isMoving=!1,new ResizeObserver(()=>this.resize()).observe(e.parentElement),this.resize()}side(){return{scene:new Fs,materials:ac(!1),isColored:!1,surface:null,coarse:[],marks:new Map}}setMesh(e,{drawn:t,positions:n,normals:s,colors:r,bulk:{bounds:o}},a){this.clear(e);let l=n.subarray(0,t*9),c=this.sides[e];c.isColored!==!!r&&Object.assign(c,{isColored:!!r,materials:ac(!!r)});let h=this.isSoftware&&l.length/9>gx;c.surface=lc({positions:l,normals:s,colors:r},h?c.materials.both:c.materials.sides),c.scene.add(c.surface),a&&(this.easing=0,this.size=o.min.map((d,u)=>o.max[u]-d),this.camera.setScene(Math.hypot(...this.size)/2||1),this.layBed()),this.applyAll()}setCoarse(e,t){let n=this.sides[e];if(n.surface){for(n.coarse=t.map(s=>lc(s,n.materials.coarse)),n.scene.add(...n.coarse),this.isMoving=!0;this.easing<lr.length-1&&this.measure()>nd;)this.easing+=1;this.isMoving=!1,this.invalidate()}}measure(){return this.timed(),this.timed()}timed(){let e=this.renderer.getContext(),t=performance.now();return this.draw(),e.readPixels(0,0,1,1,e.RGBA,e.UNSIGNED_BYTE,new Uint8Array(4)),performance.now()-t}watch(e){let t=e-this.lastFrame;this.lastFrame=this.isMoving?e:NaN,this.slow=t>nd?(this.slow??0)+1:0,!(this.slow<2||this.easing===lr.length-1)&&(this.slow=0,this.easing+=1,this.onEased())}clear(e){let t=this.sides[e];for(let n of[...t.marks.keys()])this.setMarks(e,n,null);for(let n of[t.surface,...t.coarse])n?.geometry.dispose(),n?.removeFromParent();Object.assign(t,{surface:null,coarse:[]}),e==="before"&&(this.size=null,this.layBed()),this.invalidate()}layBed(){for(let e of Object.values(this.sides))oc(e.bed),e.bed=this.size?Xu(this.size,ka(this.themeName).grid):null,e.bed&&e.scene.add(e.bed)}setMarks(e,t,n,s,r){let o=this.sides[e];if(oc(o.marks.get(t)),o.marks.delete(t),n){let a=Qu(n,s,this.shared,r);o.marks.set(t,a),o.scene.add(a)}this.invalidate()}showMarks(e,t,n){let s=this.sides[e].marks.get(t);s&&(s.visible=n),this.invalidate()}setValues(e,t){let{surface:n}=this.sides[e];n&&ed(n,t),this.invalidate()}set(e){Object.assign(this.settings,e),this.applyAll()}setTheme(e){this.themeName=e,this.layBed(),this.applyAll()}setSection(e,t){let s=this.section?.axis===e?this.section.sign:Math.sign(this.camera.direction().getComponent(e))||1;this.section=t===null?null:{axis:e,at:t,sign:s},this.applyAll()}applyAll(){let{section:e,settings:t}=this,n=ka(this.themeName),s=[0,0,0,0];e&&this.size&&(s[e.axis]=e.sign,s[3]=e.sign*(e.at-.5)*this.size[e.axis]*1.002),this.shared.plane.value=s,this.shared.isCut.value=!!e;for(let[r,o]of Object.entries(this.sides)){let a={base:wn(n.base),fresh:wn(r==="before"?n.gone:n.fresh),back:wn(n.back),cut:wn(n.cut),edge:wn(n.edge),plane:s,isCut:!!e,mode:td(t.colors),isSmooth:t.smooth,hasEdges:t.edges,hasBacks:t.backs};for(let[l,c]of Object.entries(a))o.materials.uniforms[l].value=c;o.bed&&(o.bed.visible=t.grid)}this.invalidate()}fly(e,t,n){this.camera.fly(new N(...e),new N(...t),n)}comeBack(){this.setAspect(),this.camera.comeBack()}resize(){let{clientWidth:e,clientHeight:t}=this.canvas.parentElement;!e||!t||(this.renderer.setPixelRatio(Math.min(devicePixelRatio,2)*this.ease.pixels),this.renderer.setSize(e,t,!1),this.setAspect(),this.invalidate())}get ease(){return lr[this.isMoving?this.easing:0]}setAspect(){let{clientWidth:e,clientHeight:t}=this.canvas.parentElement,n=this.settings.arrangement==="beside"?e/2:e;this.camera.camera.aspect=n/t,this.camera.camera.updateProjectionMatrix()}moved(){this.isMoving=!0,this.waitForRest(),this.invalidate()}hold(e){this.isHeld=e,this.waitForRest()}waitForRest(){clearTimeout(this.rest),this.isHeld||(this.rest=setTimeout(()=>{this.isMoving=!1,this.invalidate()},mx))}invalidate(){this.isAsked||(this.isAsked=!0,requestAnimationFrame(e=>{this.isAsked=!1,this.watch(e),this.draw()}))}draw(){let{clientWidth:e,clientHeight:t}=this.canvas.parentElement;if(!e||!t)return;let{arrangement:n,divider:s}=this.settings,r=Math.min(devicePixelRatio,2)*this.ease.pixels;if(this.renderer.getPixelRatio()!==r&&this.resize(),this.setAspect(),this.shared.pixels.value.set(e/(n==="beside"?2:1),t),this.renderer.setScissorTest(!0),n==="beside")this.drawSide("before",[0,e/2],[0,e/2],t),this.drawSide("after",[e/2,e],[e/2,e],t);else if(n==="slider"){let o=Math.round(e*s);this.drawSide("before",[0,e],[0,o],t),this.drawSide("after",[0,e],[o,e],t)}else this.drawSide(n,[0,e],[0,e],t);this.onDrawn()}easedCopy(e){let{copy:t}=lr[this.easing],{coarse:n}=this.sides[e];return t===null?void 0:n[Math.min(t,n.length-1)]}drawSide(e,[t,n],[s,r],o){let a=this.sides[e],l=this.isMoving&&this.easedCopy(e)||a.surface;for(let c of[a.surface,...a.coarse])c&&(c.visible=c===l);for(let{hidden:c}of a.marks.values())c.visible=this.ease===lr[0];this.renderer.setViewport(t,0,n-t,o),this.renderer.setScissor(s,0,r-s,o),this.renderer.render(a.scene,this.camera.camera)}project(e){let{clientWidth:t,clientHeight:n}=this.canvas.parentElement,s=new N(...e).project(this.camera.camera),r=this.settings.arrangement==="beside"?.5:1;return s.z>1?null:[(s.x+1)/2*t*r,(1-s.y)/2*n]}};function vx(){let i=document.createElement("canvas").getContext("webgl2"),e=i?.getExtension("WEBGL_debug_renderer_info"),t=e?i.getParameter(e.UNMASKED_RENDERER_WEBGL):"";return i?.getExtension("WEBGL_lose_context")?.loseContext(),/swiftshader|llvmpipe|software/i.test(t)}var xx=4e6,ba=class{view=null;tools=null;constructor({api:e,meshes:t,current:n,sized:s}){Object.assign(this,{api:e,meshes:t,current:n,sized:s})}get session(){return this.current()}async draw(e,t,n,s=this.session.fileUnit){let r=this.session,o=await this.meshes.ask("read",{name:e,bytes:t,fileName:n,scale:s,isFirst:e==="before"},[t]);if(r!==this.session)return null;let a=new yr(o);r.pictures[e]=a,this.view?.setMesh(e,a,e==="before"),B("view").dataset.drawn=Object.keys(r.pictures).join(" "),e==="before"&&this.sized(a),this.tools?.colorsCame(e),this.tellFar(),a.project?.setParts(r.report?.parts??[],r.report?.before.counts.faces),r.report&&e==="before"&&this.overlays();let l=await this.meshes.ask("look",{name:e,sizes:id});return r!==this.session?null:(Object.assign(a,{rims:l.rims,edges:l.edges}),l.coarse.length&&this.view?.setCoarse(e,l.coarse),this.tellEased(),r.report&&e==="before"&&this.overlays(),a)}tellEased(){if(B("coarse").hidden=!this.view?.easing,!this.view?.easing)return;let e=this.view.easedCopy("before");B("coarse").textContent=e?Q("view.coarse",{n:$e(e.geometry.index.count/3),m:$e(this.session.pictures.before.drawn)}):Q("view.rough")}tellFar(){let e=this.session?.pictures.before?.bulk.far??0;B("far").hidden=!e,B("far").textContent=Ei("view.far",e)}async drawFromService(){let e=this.session,{input:t}=e.report,s=["stl","obj","ply","off","3mf"].includes(t.format)&&!e.file?t.format:"ply",r=e.unit||t.units.unit,o=await this.converted(s,r,{input:{job:e.inputJob}});if(!o||e!==this.session)return;let a=await this.draw("before",o,`mesh.${s}`);a&&e.file&&await this.seekPictures(a,e.file),a&&t.format==="3mf"&&!a.project&&(a.project=$c,this.overlays())}async converted(e,t,n,s=null){let r=await this.api.follow(await this.api.create({operation:"convert",output_format:e,units:t,output_units:t,...n},s),()=>{});return r.links.result?(await this.api.file(r.links.result)).blob.arrayBuffer():null}async drawResult(e,t=0){let n=this.session;delete n.pictures.after;let{blob:s,name:r}=await this.api.file(cc(e,t)),o=await s.arrayBuffer();if(n!==this.session||(await this.draw("after",o,r,n.reportUnit).catch(async l=>{if(l.code!=="not-drawn-here")throw l;let c=await this.converted("ply",n.report.output_units,{},new File([s],r)),h=c&&n===this.session&&await this.draw("after",c,"mesh.ply",n.reportUnit);h&&await this.seekPictures(h,s)}),!n.pictures.before||!n.pictures.after||n!==this.session))return;let a=await this.meshes.ask("compare");n===this.session&&(n.pictures.before.kept=a.before,n.pictures.after.kept=a.after,n.maps={},B("colors").value=this.tools?.hasColors?"file":"kept",this.tools?.offer(!0))}async seekPictures(e,t){e.isTextured||=(await t.slice(0,xx).text()).includes('"baseColorTexture"'),this.tools?.tellTextures()}overlays(){let e=this.session.pictures.before;if(!(!e||!this.session.report)){e.project?.setParts(this.session.report.parts??[],this.session.report.before.counts.faces);for(let t of this.session.report.before.defects)this.view?.setMarks("before",t.code,e.overlayOf(t,this.session.reportUnit),ki(t.code),.5),this.view?.showMarks("before",t.code,this.session.shown.has(t.code))}}light(e,t,n="before",s=null){this.session.lit=e?{place:e&&Ms(e,s).place,side:n}:null;for(let r of["before","after"])this.view?.setMarks(r,"lit",null);e&&this.view?.setMarks(n,"lit",e,t,1.3),this.ring()}ring(){let e=this.session?.lit&&this.view?.project(this.session.lit.place);B("ring").hidden=!e,e&&(B("ring").style.transform=`translate(${e[0]}px, ${e[1]}px)`)}},cc=(i,e)=>e?`${i.links.result}?level=${e+1}`:i.links.result;var _a=class{constructor(){this.worker=new Worker("/worker.js"),this.waiting=new Map,this.count=0,this.worker.onmessage=({data:e})=>{let{resolve:t,reject:n}=this.waiting.get(e.id);this.waiting.delete(e.id),e.problem?n(new Lt({code:e.problem,detail:e.detail})):t(e.answer)}}ask(e,t={},n=[]){this.count+=1;let s=this.count;return this.worker.postMessage({id:s,work:e,...t},n),new Promise((r,o)=>{this.waiting.set(s,{resolve:r,reject:o})})}};var yx={um:.001,mm:1,cm:10,m:1e3,in:25.4,ft:304.8},Sx=/[\u0000-\u001f\u007f\\/:*?"<>|]/g,wa=i=>yx[i]??1,Ea=class{constructor(e,t=null,n=!0){this.name=e,this.isNamed=n,this.file=t,this.inputJob=null,this.job=null,this.unit="",this.policy="",this.partCount=0,this.solid="separate",this.asked=null,this.isAskedKnown=!0,this.format=null,this.given=null,this.level=0,this.looks=0,this.report=null,this.pictures={},this.size=null,this.choices=new wi,this.shown=new Set,this.place=null}get stem(){return this.name.replace(/\.[^.]*$/,"")||"mesh"}named(e){let[t,n]=[[...this.stem.replaceAll('"',"%22")],[...e]];return!this.isNamed||!t.every((s,r)=>[s,"_"].includes(n[r]))?e:this.downloadStem+n.slice(t.length).join("")}get downloadStem(){return this.stem.replace(Sx,"_")}get fileUnit(){return wa(this.unit||this.report?.input.units.unit||"mm")}get reportUnit(){return wa(this.report.output_units)}get plan(){return this.partCount<2||this.solid==="together"?this.report?.plan:null}get isRepaired(){return this.report?.operation==="repair"}defect(e){return this.report.before.defects.find(t=>t.code===e)}options({unit:e,policy:t}=this){return{samples:1e3,...e?{units:e}:{},...t?{policy:t}:{},...this.solid==="together"?{parts:"together"}:{}}}take(e){this.unit=e.units??"",this.policy=e.policy??"",this.solid=e.parts??"separate",e.parts&&(this.partCount=2),this.format=e.output_format??null,this.choices=wi.of(e)}repairOptions(e=this){return{...this.options(e),...this.solid==="union"?{parts:"union"}:{},...this.choices.options(this.plan)}}};function sd({input:i,printing:e,levels:t,verdict:n,certificate:s}){let r=t.map(({target:o})=>o.ratio).filter(Boolean);return{...i.units.is_stated&&!["3mf","glb","gltf"].includes(i.format)?{units:i.units.unit}:{},...e?{policy:e.policy}:{},...n.outcome==="partial"?{require:"best_effort"}:{},...r.length>1?{targets:r.map(o=>({ratio:o}))}:{ratio:r[0]},...s?{output_format:uc(s)}:{}}}var uc=i=>i.encoding.split("-")[0];function rd(i){let e={...i.asked,...i.format?{output_format:i.format}:{}};delete e.samples;let t=Object.keys(e).length?` -F ${hc(`params=${JSON.stringify(e)};type=application/json`)}`:"",n=`mesh=@"${i.name.replace(/[\\"]/g,"\\$&")}"`,s=`${i.stem}-repaired.${i.format??i.report.input.format}`;return`curl --fail-with-body -F ${hc(n)}${t} ${location.origin}/v1/repair -o ${hc(s)}`}var hc=i=>`'${i.replaceAll("'","'\\''")}'`;function dc({size:i,triangleCount:e,fileUnit:t,unit:n,report:s}){let r=(a,l)=>`${i.map(c=>Nn(c/a)).join(" \xD7 ")} ${l}`,o=t===1?"":` (${r(t,n||s.input.units.unit)})`;B("size").textContent=r(1,"mm")+o,B("dimensions").textContent=B("size").textContent,B("triangles").textContent=$e(e)}function od(i){let{unit_hypothesis:e,measures:t}=i.before,n=e&&!i.input.units.is_stated&&e.plausible.length>1;if(B("unit-question").hidden=!n,!n)return;let{min:s,max:r}=t.bounds,o=Math.max(...r.map((l,c)=>l-s[c])),a=e.plausible.map(l=>Q("unit.as",{a:`${Nn(o*wa(l),3)} mm`,u:l}));B("unit-question").textContent=Q("unit.question",{a:a.join(", ")})}var Mx=["auto","flat","minimal","smooth","creased","rbf"],ad={error:0,warning:1,info:2};function ld(i,e){let t=[...i.report.before.defects].sort((n,s)=>ad[n.severity]-ad[s.severity]);return t.length===0?W("p",{className:"calm"},Q("findings.none")):W("ul",{className:"findings"},t.map(n=>bx(n,i,e)))}var cd=i=>i.severity==="error";function bx(i,e,t){let{code:n,severity:s,count:r,is_at_least:o}=i,a=Q(`defect.${n}`),l=W("div",{className:"finding-body",hidden:!0,id:`finding-${n}`}),c=W("button",{type:"button",className:"finding-title","aria-expanded":"false","aria-controls":l.id,"data-code":n,onclick:()=>t.visit(n,0,c.getAttribute("aria-expanded")==="true")},W("span",{className:"name"},a),_x(i),W("span",{className:"count"},o?Q("or.more",{n:$e(r)}):$e(r))),h=W("input",{type:"checkbox",checked:e.shown.has(n),"aria-label":Q("show.in.view",{x:a}),title:Q("show.in.view",{x:a}),onchange:d=>t.show(n,d.target.checked)});return h.style.setProperty("--swatch",ki(n)),W("li",{className:`finding ${s}`,"data-code":n},W("div",{className:"finding-row"},h,c),l)}function _x({fixed:i,count:e}){if(i==null)return null;let t=i>=e;return W("span",{className:t?"tag good":"tag"},t?Q("fixed"):Ei("left",e-i))}function Oi(i,e,t,n,s){for(let r of i.querySelectorAll(".finding")){let o=r.dataset.code===n,a=r.querySelector(".finding-body");r.querySelector(".finding-title").setAttribute("aria-expanded",String(o)),a.hidden=!o,o?wx(a,e,t,n,s):a.replaceChildren()}}function wx(i,e,t,n,s){let r=e.defect(n),o=e.plan?.findings.find(c=>c.code===n),l=i.contains(document.activeElement)?document.activeElement.dataset.role:null;i.replaceChildren(...[W("p",{className:"severity"},Q(`severity.${r.severity}`)),o&&Ex(o,e,t,s),r.witnesses.length>0&&Ax(r,o,e,t,s)].filter(Boolean)),l&&i.querySelector(`[data-role="${l}"]`)?.focus(),i.querySelector("[aria-current]")?.scrollIntoView({block:"nearest"})}function Ex(i,e,t,n){let{code:s,remedy:r,choices:o,confidence:a,reason:l}=i,c=e.choices.remedies.get(s)??r,h=o.length>1?ti(o.map(d=>[d,Q(`remedy.${d}`)]),c,d=>{e.choices.setRemedy(s,d),t.changed()},{"data-role":"remedy"}):W("span",{},Q(`remedy.${r}`));return W("div",{className:"remedy"},ni(Q("what.to.do"),h),W("small",{title:l},Q("sure",{p:Dn(i.elements[n]?.confidence??a)})))}function Ax(i,e,t,n,s){let{code:r,count:o,witnesses:a}=i,l=c=>()=>n.step(c);return W("div",{className:"places"},W("div",{className:"stepper"},W("button",{type:"button",className:"quiet","data-role":"previous",onclick:l(-1)},`\u2039 ${Q("previous")}`),W("span",{"aria-live":"polite"},Q("place.told",{x:Q("places"),n:$e(s+1),m:$e(a.length)})),W("button",{type:"button",className:"quiet","data-role":"next",onclick:l(1)},`${Q("next")} \u203A`)),a.length<o&&W("p",{className:"note"},Q("findings.first",{n:$e(a.length),m:$e(o)})),W("ol",{className:"place-list"},a.map((c,h)=>W("li",{},W("button",{type:"button",className:"place","aria-current":h===s?"true":void 0,"data-role":`place-${h}`,onclick:()=>n.visit(r,h)},Tx(c,h,t)),h===s&&e?.elements[h]&&Rx(e,h,t,n)))))}function Tx(i,e,t){let s=(a=>i.figures.find(l=>l.name===a)?.value)("diameter"),r=s?`, ${Un(s*t.reportUnit)}`:"";return(i.hole&&ei(`hole.${i.hole}`)?Q("hole",{n:e+1,x:Q(`hole.${i.hole}`)}):Q("place",{n:e+1}))+r}function Rx(i,e,t,n){let{code:s,choices:r,elements:o}=i,{number:a,remedy:l}=o[e],c=t.choices.element(s,a),h=t.choices.remedies.get(s)??l,d=S=>{t.choices.setElement(s,a,S),n.changed(),n.refresh()},u=[["",Q("as.all",{x:Q(`remedy.${h}`)})],...r.map(S=>[S,Q(`remedy.${S}`)])],v=s==="boundary-loop"&&(c.remedy||h)==="fill"&&ni(Q("how"),ti(Mx.map(S=>[S==="auto"?"":S,Q(`method.${S}`)]),c.method??"",S=>d({method:S}),{"data-role":"method"}));return W("div",{className:"element"},ni(Q("what.to.do"),ti(u,c.remedy??"",S=>d({remedy:S}),{"data-role":"element"})),v)}function Zn(i,e=null){B("progress").hidden=!1,B("stage").textContent=i,e===null?B("bar").removeAttribute("value"):B("bar").value=e}function gs(){B("progress").hidden=!0,B("cancel").hidden=!0}function hd({name:i,data:e}){i==="state"&&Zn(Q(e.state==="queued"?"status.queued":e.state==="running"?"stage.read":"status.done"),e.state==="running"?0:null),i==="stage"&&Zn(Q(`stage.${e.stage}`),e.fraction),i==="progress"&&Zn(e.progress.stage?Q(`stage.${e.progress.stage}`):Q("status.queued"),e.progress.fraction)}function fc(i){let e=`problem.${kc[i.code]??i.code??"other"}`;return Q(ei(e)?e:"problem.other")}function cr(i,e){let t=W("div",{className:"notice",role:"alert","data-code":i.code??"other"},W("p",{},fc(i)),i.message&&W("details",{},W("summary",{},Q("detail")),W("p",{lang:"en"},i.message)),W("div",{className:"row links"},e&&W("button",{type:"button",className:"quiet",id:"look-again",onclick:e},Q("look.again")),W("button",{type:"button",className:"quiet",id:"dismiss",onclick:()=>t.remove()},Q("dismiss"))));B("notices").replaceChildren(t),t.scrollIntoView({block:"nearest"})}var pc=()=>B("notices").replaceChildren();var Cx=({name:i,object:e,volume:t})=>i||(t===null?Q("part.object",{n:e}):Q("part.volume",{n:e,m:t+1}));function ud(i,e){let{parts:t=[],remarks:n=[]}=i;return t.length===0&&n.length===0?null:W("section",{id:"parts"},t.length>0&&W("h3",{},Q("parts")),t.length>0&&W("ul",{className:"findings parts"},t.map((s,r)=>Px(s,r,e))),n.length>0&&W("details",{},W("summary",{},Q("remarks",{n:$e(n.length)})),W("ul",{lang:"en",className:"steps"},n.map(s=>W("li",{},s)))))}function Px(i,e,t){let{verdict:n,instances:s,triangles_before:r,triangles_after:o,attributes:a}=i,l=o===null||o===r?$e(r):`${$e(r)} \u2192 ${$e(o)}`,h=[s===1?"":s===0?Q("part.unused"):Q("part.times",{n:$e(s)}),o!==null&&n.outcome&&Q(`outcome.${n.outcome}`),a&&a.kept_area_share!==null&&Q("part.attributes",{p:Dn(a.kept_area_share)})].filter(Boolean);return W("li",{className:"part"},W("button",{type:"button",className:"finding-title","data-part":String(e),onclick:()=>t.visitPart(e)},W("span",{className:"name"},Cx(i),h.length>0&&W("small",{},h.join(" "))),W("span",{className:n.printable?"tag good":"tag"},Q(n.printable?"part.sound":"part.broken")),W("span",{className:"count"},l)))}function dd(i,e,t){let n=W("p",{className:"answer",role:"status",id:"verified"}),s=async a=>{n.className="answer",n.textContent=Q("view.working");try{let{digest:l,isValid:c}=await t.verify(a),h=i.includes(l);n.classList.add(h&&c?"good":"bad"),n.textContent=`${e(h?"verify.same":"verify.other")} ${Q(c?"verify.valid":"verify.invalid")}`}catch(l){n.classList.add("bad"),n.textContent=t.words(l)}},r=W("input",{type:"file",id:"verify-file",className:"unseen",onchange:()=>{r.files[0]&&s(r.files[0]),r.value=""}}),o=W("label",{className:"drop small",for:"verify-file"},W("strong",{},Q("verify")),W("span",{},e("verify.more")));return mc(o,([a])=>s(a)),W("div",{className:"verify"},r,o,n)}function mc(i,e){let t=(n,s)=>{n.preventDefault(),n.stopPropagation(),i.classList.toggle("over",s)};i.addEventListener("dragover",n=>t(n,!0)),i.addEventListener("dragleave",n=>t(n,!1)),i.addEventListener("drop",n=>{t(n,!1);let s=[...n.dataTransfer.files];s.length&&e(s)})}var Lx=["stl","obj","ply","off","3mf","glb","gltf"];function pd({report:i,policy:e}){let{verdict:t,operation:n,certificate:s,before:r}=i,o=n==="repair",a=o&&!s,l=o?!a&&t.printable:t.printable,c=r.defects.filter(({severity:u})=>u==="error").length,h=o?Q(a?"verdict.refused":l?"verdict.repaired":"verdict.partial"):Q(l?"verdict.good":"verdict.bad"),d=o?Q(`outcome.${t.outcome??"refused"}`):l?Q("verdict.good.more"):Ei("verdict.bad.more",c);return W("div",{className:`card ${l?"good":"bad"}`},W("h2",{},W("span",{className:"icon","aria-hidden":"true"},l?"\u2713":"!"),h),W("p",{},d),t.fidelity&&W("p",{className:`fidelity ${t.fidelity}`},Q(`fidelity.${t.fidelity}`)),t.changes.length>0&&W("ul",{},t.changes.map(u=>W("li",{title:u.message},Ix(u,i)))),a&&t.reasons.length>0&&W("details",{},W("summary",{},Q("detail")),W("ul",{lang:"en"},t.reasons.map(({message:u})=>W("li",{},u)))),i.printing&&Nx(t,e))}function Ix({reason:i,measured:e,limit:t},n){let s=["lost","invented","volume"].includes(i),r=o=>s?Dn(o):i==="moved"?`${Nn(o,3)} ${n.output_units}`:$e(o);return Ei(`change.${i}`,e,{a:r(e),b:t===null?"":r(t)})}function Nx({p3_holds:i},e){return W("p",{className:`policy ${i===null?"":i?"good":"bad"}`},Q(i===null?"policy.unknown":i?"policy.holds":"policy.breaks",{p:e.toUpperCase()}))}function md({printing:i,parts:e=[]},t){let n=e.length<2;if(!i)return null;let s=r=>{let o=[W("span",{className:"name"},Q(`check.${r.code}`)),W("span",{className:"count"},Dx(r))],a=n&&r.witnesses[0]?.position;return W("li",{className:`check ${r.status??"unknown"}`,title:r.message},a?W("button",{type:"button",className:"finding-title",onclick:()=>t.flyToCheck(r)},o):W("span",{className:"finding-title"},o))};return W("section",{},W("h3",{},Q("process")),W("ul",{className:"findings checks"},i.checks.map(s)))}function Dx({measured:i,unit:e,error:t,warning:n}){let s={mm:Un,degrees:o=>`${Nn(o,3)}\xB0`,share:Dn,count:$e}[e]??$e,r=t??n;return i===null?"\u2013":r===null?s(i):`${s(i)} / ${s(r)}`}function gd(i,e){let{report:t}=i,{certificate:n,deviation:s,actions:r}=t;if(!n)return null;let o=d=>Q(t.verdict.printable?d:`${d}.partial`),a=t.input.format,l=i.isAskedKnown?Lx:[i.given],c=ti(l.map(d=>[d,d===a?Q("format.same",{f:d.toUpperCase()}):d.toUpperCase()]),i.format??a,d=>{i.format=d},{id:"format"}),h=r.flatMap(d=>d.changes.filter(({count:u})=>u>0).map(Ux));return W("section",{className:"result"},W("h3",{},Q("result")),W("dl",{className:"figures"},...gc(Q("triangles"),`${$e(t.before.counts.triangles)} \u2192 ${$e(n.triangles)}`),...s.hausdorff_max===null?[]:gc(Q("deviation"),Un(s.hausdorff_max*i.reportUnit)),...Bx(t,i.reportUnit)),t.levels.length>1&&Ox(i,e),W("div",{className:"row"},ni(Q("format"),c),W("button",{type:"button",className:"primary",id:"download",onclick:()=>e.download(i.format??a)},Q("download"))),W("div",{className:"row links"},W("button",{type:"button",className:"quiet",onclick:()=>e.openReport()},Q("report")),W("button",{type:"button",className:"quiet",onclick:()=>fd(t,`${i.downloadStem}.report.json`)},Q("report.json")),Oa(Q("copy.curl"),()=>e.curl())),h.length>0&&W("details",{},W("summary",{},Q("changed.steps")),W("ul",{className:"steps"},h)),W("h3",{},o("certificate")),W("p",{className:"hash"},W("span",{},o("hash")),W("code",{id:"hash"},n.sha256),W("span",{className:"ends"},Oa(Q("copy"),()=>n.sha256),W("button",{type:"button",className:"quiet",id:"certificate",onclick:()=>fd(n,`${i.downloadStem}.certificate.json`)},Q("certificate.save")))),dd([n,...t.levels.map(d=>d.certificate)].map(({sha256:d})=>d),o,e))}function Ux({name:i,count:e}){let t=`done.${i}`;return W("li",{lang:ei(t)?void 0:"en"},Q("done",{x:ei(t)?Q(t):i.replaceAll("_"," "),n:$e(e)}))}function Ox(i,e){let{levels:t}=i.report,n=(s,r)=>W("li",{},W("button",{type:"button",className:"finding-title","data-level":String(r),"aria-pressed":String(r===i.level),title:`SHA-256 ${s.certificate.sha256}`,onclick:()=>e.showLevel(r)},W("span",{className:"name"},Q("level.told",{n:$e(s.faces_after)}),s.distance&&W("small",{},Q("level.away",{d:Un(Fx(s)*i.reportUnit)}))),!s.is_reached&&W("span",{className:"tag"},Q("level.short"))),W("button",{type:"button",className:"quiet","data-level-file":String(r),"aria-label":`${Q("download")}: ${Q("level.told",{n:$e(s.faces_after)})}`,onclick:()=>e.downloadLevel(r)},"\u2913"));return W("div",{},W("h3",{},Q("levels")),W("ol",{className:"findings levels"},t.map(n)))}var Fx=({distance:i})=>Math.max(i.input_to_result.max,i.result_to_input.max),gc=(i,e)=>[W("dt",{},i),W("dd",{},e)],fd=(i,e)=>Bi(new Blob([JSON.stringify(i,null,2)],{type:"application/json"}),e);function Bx(i,e){let t=(i.after??i.before).measures.volume;return t===null?[]:gc(Q("volume"),`${Nn(t*e**3/1e3)} cm\xB3`)}var xd=32,vd=["union","intersection","difference"];function yd(i,{combine:e,openFirst:t}){let n=vd[0],s=o=>()=>{r.remove(),o()},r=W("div",{className:"card several",role:"group","aria-labelledby":"several-title"},W("h2",{id:"several-title"},Q("several",{n:i.length})),W("ol",{},i.map(o=>W("li",{},o.name))),ni(Q("several.how"),ti(vd.map(o=>[o,Q(`several.${o}`)]),n,o=>{n=o},{id:"several-how"})),W("div",{className:"row"},W("button",{type:"button",className:"primary",id:"several-combine",onclick:s(()=>e(n))},Q("several.combine")),W("button",{type:"button",className:"quiet",onclick:s(t)},Q("several.first"))));B("notices").replaceChildren(r),B("several-how").focus()}var kx={smooth:"smooth",edges:"edges",backs:"backs",grid:"grid"},Aa=class{constructor(e,t,n){this.view=e,this.meshes=t,this.session=n;for(let[s,r]of Object.entries(kx))B(s).addEventListener("click",()=>{let o=B(s).getAttribute("aria-pressed")!=="true";B(s).setAttribute("aria-pressed",String(o)),e.set({[r]:o})});B("fit").addEventListener("click",()=>e.camera.fit());for(let s of document.querySelectorAll("[data-look]"))s.addEventListener("click",()=>e.camera.look(s.dataset.look));for(let s of document.querySelectorAll("#arrangement [data-arrangement]"))s.addEventListener("click",()=>this.arrange(s.dataset.arrangement));B("section").addEventListener("click",()=>this.section(B("section").getAttribute("aria-pressed")!=="true"));for(let s of["section-axis","section-at"])B(s).addEventListener("input",()=>this.section(!0));B("colors").addEventListener("change",()=>this.color(B("colors").value)),this.divider(),this.keys()}arrange(e){for(let t of document.querySelectorAll("#arrangement [data-arrangement]"))t.setAttribute("aria-pressed",String(t.dataset.arrangement===e));B("divider").hidden=e!=="slider",B("view").dataset.arrangement=e,this.view.set({arrangement:e})}section(e){B("section").setAttribute("aria-pressed",String(e)),B("section-tools").hidden=!e,this.view.setSection(Number(B("section-axis").value),e?Number(B("section-at").value):null)}divider(){let e=B("divider"),t=n=>{let s=Math.min(.98,Math.max(.02,n));e.style.left=`${s*100}%`,e.setAttribute("aria-valuenow",String(Math.round(s*100))),this.view.set({divider:s})};e.addEventListener("pointerdown",n=>e.setPointerCapture(n.pointerId)),e.addEventListener("pointermove",n=>{if(!e.hasPointerCapture(n.pointerId))return;let s=B("view").getBoundingClientRect();t((n.clientX-s.left)/s.width)}),e.addEventListener("keydown",n=>{let s={ArrowLeft:-.02,ArrowDown:-.02,ArrowRight:.02,ArrowUp:.02,PageDown:-.1,PageUp:.1,Home:-1,End:1}[n.key];s&&(n.preventDefault(),t(this.view.settings.divider+s))})}keys(){let{camera:e}=this.view,t={ArrowLeft:()=>e.turn(-1,0),ArrowRight:()=>e.turn(1,0),ArrowUp:()=>e.turn(0,1),ArrowDown:()=>e.turn(0,-1),"+":()=>e.zoom(.85),"-":()=>e.zoom(1/.85),f:()=>e.fit(),F:()=>e.fit()};B("canvas").addEventListener("keydown",n=>{!t[n.key]||n.ctrlKey||n.metaKey||n.altKey||(n.preventDefault(),t[n.key]())})}get hasColors(){return Object.values(this.session()?.pictures??{}).some(({colors:e})=>e)}colorsCame(e){B("colors").options[0].hidden=!this.hasColors,B("colors").options[0].disabled=!this.hasColors,e==="before"&&this.hasColors&&B("colors").value==="plain"&&this.color(B("colors").value="file"),this.tellTextures()}tellTextures(){B("textured").hidden=!Object.values(this.session()?.pictures??{}).some(({isTextured:e})=>e)}offer(e){B("arrangement").hidden=!e;for(let t of B("colors").options)t.disabled=!e&&["kept","deviation"].includes(t.value);e||(B("colors").value=this.hasColors?"file":"plain"),this.colorsCame("after"),this.color(B("colors").value),this.arrange(e?"slider":"before")}async color(e){let t=this.session();if(B("legend").hidden=["plain","file"].includes(e),this.view.set({colors:e}),B("legend").hidden)return;B("legend").replaceChildren(Q("view.working"));let n=await this.maps(t,e);if(!(this.session()!==t||B("colors").value!==e)){for(let[s,r]of Object.entries(n.bytes))this.view.setValues(s,r);B("legend").replaceChildren(...n.legend())}}async maps(e,t){return e.maps??={},e.maps[t]??=await this[t](e),e.maps[t]}async kept({pictures:e}){let{before:t,after:n}=e,s=l=>l&&Uint8Array.from({length:l.length*3},(c,h)=>l[h/3|0]?ar:0),r=l=>$e(l.reduce((c,h)=>c+h,0)),o=l=>$e(l.reduce((c,h)=>c+1-h,0)),a=(l,c,h)=>Sd(l,`${Q(c)} ${h}`);return{bytes:{before:s(t.kept),after:s(n.kept)},legend:()=>[a("kept","legend.kept",r(n.kept)),a("new","legend.new",o(n.kept)),a("gone","legend.gone",o(t.kept))]}}async deviation(){let e=await this.meshes.ask("deviation"),t=Math.max(...[e.before,e.after].map(s=>s.reduce((r,o)=>Math.max(r,o),0)));return{bytes:Object.fromEntries(Object.entries(e).map(([s,r])=>[s,Uint8Array.from(r,o=>t>0?Math.round(o/t*254):0)])),legend:()=>Md("0 mm",Un(t))}}async thickness({pictures:e}){let t=Object.keys(e),n=await Promise.all(t.map(c=>this.meshes.ask("thickness",{name:c}))),s=n.flatMap(c=>[...c.filter((h,d)=>d%3===0&&Number.isFinite(h))]).sort((c,h)=>c-h),r=s[Math.floor(s.length*.9)]??1,o=c=>Number.isFinite(c)?Math.round((1-Math.min(1,c/r))*254):ar,a=Object.fromEntries(t.map((c,h)=>[c,Uint8Array.from(n[h],o)])),l=n.some(c=>c.some(Number.isNaN));return{bytes:a,legend:()=>[...Md(`\u2265 ${Un(r)}`,"0 mm"),...l?[Sd("kept",Q("legend.unmeasured"))]:[]]}}},Sd=(i,e)=>W("span",{},W("i",{className:`swatch ${i}`}),e),Md=(i,e)=>[W("span",{},i),W("i",{className:"ramp"}),W("span",{},e),W("small",{},Q("legend.about"))];var Ta=null;function Ra(){if(Ta)return Ta;try{let i=JSON.parse(localStorage.getItem("jobs"));return Array.isArray(i)?i:[]}catch{return[]}}function bd(i,e,t){let n=[{id:i.id,operation:i.operation,name:e,at:Date.now(),asked:t},...Ra().filter(({id:s})=>s!==i.id)];Ed(n.slice(0,20))}var _d=()=>Ed([]),wd=i=>Ra().find(e=>e.id===i);function Ed(i){for(let e=5e5;e>1;e=Math.floor(e/8))try{localStorage.setItem("jobs",JSON.stringify(zx(e,i))),Ta=null;return}catch{}Ta=i}function zx(i,e){let t=i;return e.map(({asked:n,...s})=>(t-=JSON.stringify(n??null).length,t<0?s:{...s,asked:n}))}var yi=()=>/^#job=([\w-]+)$/.exec(location.hash)?.[1]??null,Ca=i=>history.replaceState(null,"",i?`#job=${i}`:location.pathname);function Ad(i){let e=new TextEncoder,[t,n]=[[],[]],s=0;for(let[a,l]of i){let[c,h]=[e.encode(a),e.encode(l)],d=[[20,2],[0,2],[0,2],[0,2],[33,2],[Hx(h),4],[h.length,4],[h.length,4],[c.length,2],[0,2]],u=vc([[67324752,4],...d]);t.push(u,c,h),n.push(vc([[33639248,4],[20,2],...d,[0,2],[0,2],[0,2],[0,4],[s,4]]),c),s+=u.length+c.length+h.length}let r=n.reduce((a,l)=>a+l.length,0),o=vc([[101010256,4],[0,2],[0,2],[i.length,2],[i.length,2],[r,4],[s,4],[0,2]]);return Vx([...t,...n,o])}var vc=i=>Uint8Array.from(i.flatMap(([e,t])=>Array.from({length:t},(n,s)=>e>>>8*s&255)));function Vx(i){let e=new Uint8Array(i.reduce((n,s)=>n+s.length,0)),t=0;for(let n of i)e.set(n,t),t+=n.length;return e}function Hx(i){let e=-1;for(let t of i){e^=t;for(let n=0;n<8;n+=1)e=e>>>1^(e&1?3988292384:0)}return~e>>>0}var xc={scan:Wx,bodies:Xx,project:qx,sound:Yx};function Td(i){let e=xc[i](),t=typeof e!="string"?"3mf":e.startsWith("OFF")?"off":"obj";return new File([e],`${i}.${t}`,{type:"application/octet-stream"})}function Wx(){let[i,e]=[56,96],t=new Si,n=(l,c)=>{let[h,d]=[Math.PI*l/i,2*Math.PI*c/e],u=1+.16*Math.sin(3*d)*Math.sin(h)**2+.1*Math.cos(5*h)+.05*Math.sin(7*d+4*h)*Math.sin(h),f=.006*Math.sin(l*12.9898+c*78.233)*Math.sin(h),v=26*(u+f);return[v*Math.sin(h)*Math.cos(d),v*Math.sin(h)*Math.sin(d),34*(1+Math.cos(h))+3*Math.cos(5*h)*Math.sin(h)]},s=(l,c)=>{let[h,d]=[l-24,(c+60)%e-40],[u,f]=[l-38,(c+20)%e-52];return h*h+d*d*.6<14||u*u*1.4+f*f<22||l===15&&c>70&&c<84||l===44&&c===12},r=[t.vertex(n(0,0))];for(let l=1;l<i;l+=1)for(let c=0;c<e;c+=1)r.push(t.vertex(n(l,c)));let o=t.vertex(n(i,0)),a=(l,c)=>l===0?r[0]:l===i?o:r[1+(l-1)*e+c%e];for(let l=0;l<i;l+=1)for(let c=0;c<e;c+=1){if(s(l,c))continue;let h=[a(l,c),a(l+1,c),a(l+1,c+1),a(l,c+1)];l===30&&c<5&&h.reverse(),t.polygon(h)}for(let l=0;l<5;l+=1){let[c,h,d]=[34+l*2.5,-18+l*7,22+l*17%23];t.polygon([[0,0,0],[1.6,.4,.3],[.5,1.5,.8]].map(([u,f,v])=>t.vertex([c+u,h+f,d+v])))}return t.off()}function Xx(){let i=new Si;return i.box([0,0,0],[60,40,6]),i.box([10,8,3],[34,32,28]),i.tube([22,20,17],6,3,50),i.ball([49,20,12.5],8,!0),i.obj()}function qx(){let[i,e,t]=[new Si,new Si,new Si];i.box([0,0,0],[80,40,4]),e.box([0,0,0],[20,24,16]),e.faces.splice(2,2),t.ball([0,0,0],9,!0);let n=(o,a,l,c)=>`<object id="${o}" name="${a}" type="model" pid="1" pindex="${c}">${l.xml()}</object>`,s=(o,a)=>`<item objectid="${o}" transform="${a}"/>`,r=`<?xml version="1.0" encoding="UTF-8"?>
<model unit="millimeter" xml:lang="en-US" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"><resources>
<basematerials id="1"><base name="Grey" displaycolor="#9AA4AE"/><base name="Yellow" displaycolor="#E3B23C"/><base name="Blue" displaycolor="#2F7FE0"/></basematerials>
${n(2,"Plate",i,0)}${n(3,"Cup",e,1)}${n(4,"Ball",t,2)}
</resources><build>${s(2,"1 0 0 0 1 0 0 0 1 0 0 0")}${s(3,"1 0 0 0 1 0 0 0 1 5 8 5")}${s(3,"-1 0 0 0 1 0 0 0 1 75 8 5")}${s(4,"1 0 0 0 1 0 0 0 1 40 20 14")}</build></model>`;return Ad([["[Content_Types].xml",'<?xml version="1.0" encoding="UTF-8"?><Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types"><Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/><Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>'],["_rels/.rels",'<?xml version="1.0" encoding="UTF-8"?><Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship Id="r0" Target="/3D/3dmodel.model" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>'],["3D/3dmodel.model",r]])}function Yx(){let i=new Si;return i.tube([0,0,0],15,8,12),i.off()}var Si=class{vertices=[];faces=[];vertex(e){return this.vertices.push(e.map(t=>Math.round(t*1e4)/1e4)),this.vertices.length-1}polygon(e){let t=e.filter((n,s)=>n!==e[(s+1)%e.length]);for(let n=2;n<t.length;n+=1)this.faces.push([t[0],t[n-1],t[n]])}box(e,t){let n=[0,1,2,3,4,5,6,7].map(s=>this.vertex([0,1,2].map(r=>(s>>r&1?t:e)[r])));for(let s of[[0,2,3,1],[4,5,7,6],[0,1,5,4],[2,6,7,3],[0,4,6,2],[1,3,7,5]])this.polygon(s.map(r=>n[r]))}tube(e,t,n,s,r=48){let o=(d,u)=>Array.from({length:r},(f,v)=>{let S=2*Math.PI*v/r;return this.vertex([e[0]+u,e[1]+d*Math.cos(S),e[2]+d*Math.sin(S)])}),[a,l,c,h]=[o(t,-s/2),o(t,s/2),o(n,s/2),o(n,-s/2)];for(let[d,u]of[[a,l],[l,c],[c,h],[h,a]])for(let f=0;f<r;f+=1)this.polygon([d[f],d[(f+1)%r],u[(f+1)%r],u[f]])}ball(e,t,n,s=20,r=32){let o=(d,u)=>{let[f,v]=[Math.PI*d/s,2*Math.PI*u/r];return[e[0]+t*Math.sin(f)*Math.cos(v),e[1]+t*Math.sin(f)*Math.sin(v),e[2]+t*Math.cos(f)]},a=this.vertex(o(0,0)),l=Array.from({length:s-1},(d,u)=>Array.from({length:r},(f,v)=>this.vertex(o(u+1,v)))),c=this.vertex(o(s,0)),h=(d,u)=>d===0?a:d===s?c:l[d-1][u%r];for(let d=0;d<s;d+=1)for(let u=0;u<r;u+=1){let f=[h(d,u),h(d+1,u),h(d+1,u+1),h(d,u+1)];this.polygon(n?f.reverse():f)}}off(){return`OFF
${this.vertices.length} ${this.faces.length} 0
${this.vertices.map(e=>e.join(" ")).join(`
`)}
${this.faces.map(e=>`3 ${e.join(" ")}`).join(`
`)}
`}xml(){return`<mesh><vertices>${this.vertices.map(([t,n,s])=>`<vertex x="${t}" y="${n}" z="${s}"/>`).join("")}</vertices><triangles>${this.faces.map(([t,n,s])=>`<triangle v1="${t}" v2="${n}" v3="${s}"/>`).join("")}</triangles></mesh>`}obj(){return`${this.vertices.map(e=>`v ${e.join(" ")}`).join(`
`)}
${this.faces.map(e=>`f ${e.map(t=>t+1).join(" ")}`).join(`
`)}
`}};var Rt=new mr,Sc=new _a,ft=new ba({api:Rt,meshes:Sc,current:()=>ne,sized:i=>Od(i)}),ne=null,hr=null,bt=null,Jn=null,jn=null;async function fn(i,e=ne){try{return pc(),await i()}catch(t){if(e!==ne)return;gs(),B("repair").disabled=!1,!ne?.report&&!ne?.pictures.before&&(document.body.dataset.state="failed"),cr(t instanceof Error?t:new Lt({code:"other"}),$x(t)&&(()=>fn(wc))),t.code==="unauthenticated"&&(B("key-form").hidden=!1),Fi(B("repair"));return}}function $x({code:i}){return ne&&!ne.report&&(ne.file||ne.inputJob)&&!/^(mesh|archive|body|unsupported|unauth)/.test(i)}function Mc(i,e,t){ne=new Ea(i,e,t),vr(),document.body.dataset.state="open",B("units").options[0].textContent="\u2013",B("repair").disabled=!1,B("repair").classList.remove("wanted");for(let n of["verdict","earlier","findings","parts-list","checks","result"])B(n).replaceChildren();for(let n of["facts","findings-section","repair-section","solid-field"])B(n).hidden=!0;Pd(),B("file-name").textContent=i,document.title=`${i} \u2013 Meshmend`,delete B("view").dataset.drawn,bt?.clear("before"),bt?.clear("after"),Jn?.offer(!1),ft.light(null),pc(),Fi(B("canvas")),Ca(null)}function Pd(){let{unit:i,policy:e,solid:t,choices:n}=ne;for(let[s,r]of Object.entries({units:i,policy:e,solid:t,levels:n.levels,share:Math.round(n.share*100)}))B(s).value=r;B("best").checked=n.takesBest,Ia()}function Rd(i){let e=[...i],t=e.some(({size:n})=>n===0);return e.length<2&&!t?ur(e[0]):(document.body.dataset.state==="start"&&(document.body.dataset.state="failed"),t?cr(new Lt({code:"file-empty"})):e.length>xd?cr(new Lt({code:"too-many-files"})):yd(e,{combine:n=>Zx(e,n),openFirst:()=>ur(e[0])}))}async function Zx(i,e){Mc(Q(`several.${e}`));let t=ne;await fn(async()=>{let n=await La({operation:"boolean",set_operation:e},i);if(t===ne){if(n.problem)throw new Lt({...n.problem,code:(await Rt.report(n)).verdict.reasons[0]?.code??n.problem.code});await Ld(n,e)}},t)}async function Ld(i,e){let t=ne,{name:n,blob:s}=await Rt.file(i.links.result);t===ne&&ur(new File([s],n.replace(/^.*(?=\.)/,e)))}async function ur(i){if(!i)return;Mc(i.name,i);let e=ne;Zn(Q("status.reading")),await fn(()=>Nd(Id(e)),e)}async function Id(i){try{return await ft.draw("before",await i.file.arrayBuffer(),i.name),i===ne&&(document.body.dataset.state="open"),null}catch(e){return{error:e}}}async function Nd(i){let e=ne,t=e.looks+=1,n={operation:"plan",...e.options(),...e.inputJob?{input:{job:e.inputJob}}:{}},s=await La(n,e.inputJob?null:e.file);e!==ne||t!==e.looks||(e.inputJob??=s.id,await bc(s),await Dd(i))}async function Dd(i){let e=ne,t=await i;if(e===ne&&t?.error?.code==="too-vast")return cr(t.error);t?.error&&e===ne&&await ft.drawFromService()}async function La(i,e){let t=ne;Zn(Q(e?"status.sending":"status.queued"));let n=await Rt.create(i,e),{operation:s,input:r,thumbnail:o,...a}=i;return bd(n,t.name,a),t!==ne?n:Ud(n)}async function Ud(i){let e=ne;Ca(i.id),hr=i,B("cancel").hidden=pr(i),B("cancel").hidden||Fi(B("cancel"));let t=await Rt.follow(i,n=>{e===ne&&hd(n)});if(hr===i&&(hr=null,B("cancel").hidden=!0),t.problem&&!t.links.report)throw new Lt(t.problem);if(t.state==="cancelled"||t.state==="expired")throw new Lt({code:t.state});return t}function Od({bounds:i,faceCount:e,faceOf:t}){ne.size=i.max.map((n,s)=>n-i.min[s]),ne.triangleCount=Math.max(e,t?.length??0),dc(ne),B("facts").hidden=!1,Ia()}async function bc(i){let e=ne,t=await Rt.report(i);if(e!==ne)return;Object.assign(e,{job:i,given:t.certificate&&uc(t.certificate)});let n=!e.report;if(e.report=t,n)for(let s of t.before.defects)cd(s)&&e.shown.add(s.code);e.checked=t.printing?.policy??"",e.partCount=Math.max(e.partCount,t.parts?.length??0),gs(),Pa(),ft.overlays()}function Pa(){let{report:i}=ne,e=document.activeElement.id;e&&vr(),B("verdict").replaceChildren(pd({report:i,policy:ne.checked})),jn=ld(ne,Dt),B("findings").replaceChildren(jn),B("parts-list").replaceChildren(...[ud(i,Dt)].filter(Boolean)),B("checks").replaceChildren(...[md(i,Dt)].filter(Boolean)),B("result").replaceChildren(...[ne.isRepaired&&gd(ne,Dt)].filter(Boolean)),B("findings-section").hidden=!1,B("repair-section").hidden=!1,B("solid-field").hidden=ne.partCount<2,B("repair").textContent=Q(ne.isRepaired?"repair.again":i.verdict.printable?"certify":"repair"),B("repair").disabled=!1;let{unit:t,is_stated:n}=i.input.units;if(B("units").options[0].textContent=n?ne.unit?"\u2013":t:Q("unit.assumed",{u:t}),B("units").disabled=i.input.format==="3mf",od(i),_c(),!ne.pictures.before&&i.before.measures.bounds){let{min:s,max:r}=i.before.measures.bounds;Od({bounds:{min:s.map(o=>o*ne.reportUnit),max:r.map(o=>o*ne.reportUnit)},faceCount:i.before.counts.triangles})}ne.size&&dc(ne),B("panel").dataset.operation=i.operation,ne.place&&Oi(jn,ne,Dt,ne.place.code,ne.place.number),e&&Fi(B(e))}var Dt={show(i,e){e?ne.shown.add(i):ne.shown.delete(i),bt?.showMarks("before",i,e)},visit(i,e,t=!1){if(t){ne.place=null,ft.light(null),Oi(jn,ne,Dt,null,0);return}ne.place={code:i,number:e},Oi(jn,ne,Dt,i,e);let n=ne.defect(i).witnesses[e],s=ne.pictures.before;if(B("view").dataset.place=`${i} ${e}`,!n||!s||!bt)return;let r=s.partsOf(i,n,ne.reportUnit,!0),o=n.position&&s.place(n.position,ne.reportUnit,n.faces[0]?.index);bt.settings.arrangement==="after"&&Jn.arrange("before"),ft.light(r,ki(i),"before",o??[0,0,0]);let{place:a,normal:l,radius:c}=Ms(r,o??[0,0,0]);bt.fly(a,l,c)},step(i){let e=[...jn.querySelectorAll(".finding")].map(({dataset:r})=>r.code).flatMap(r=>ne.defect(r).witnesses.map((o,a)=>[r,a]));if(e.length===0)return;let{code:t,number:n}=ne.place??{code:null,number:0},s=e.findIndex(([r,o])=>r===t&&o===n);Dt.visit(...e[s<0?i>0?0:e.length-1:(s+i+e.length)%e.length])},changed(){B("repair").classList.add("wanted")},refresh(){ne.place&&Oi(jn,ne,Dt,ne.place.code,ne.place.number)},flyToCheck({witnesses:i}){let e=ne.report.printing.about==="result"?"after":"before",t=ne.pictures[e];if(!t||!bt)return;let n=t.place(i[0].position,ne.reportUnit,i[0].face);if(!n)return;let s={segments:[],faces:t.facesAt([i[0].face]),points:n};bt.settings.arrangement!=="beside"&&Jn.arrange(e),ft.light({...s,faces:[]},"#f2a51c",e);let{normal:r}=Ms(s,n);bt.fly(n,r,Math.hypot(...bt.size)*.06)},visitPart(i){let e=ne.pictures.before?.whereIs(i);B("view").dataset.place=`part ${i}`,!(!e||!bt)&&(bt.settings.arrangement==="after"&&Jn.arrange("before"),ne.place=null,ft.light(e.undrawn,"#8a97a4"),Oi(jn,ne,Dt,null,0),bt.fly(e.place,[0,0,0],e.radius/2))},showLevel:i=>fn(async()=>{let e=ne;Zn(Q("status.fetching")),await ft.drawResult(e.job,i),e===ne&&(e.level=i,gs(),Pa(),B("result").querySelector(`[data-level="${i}"]`).focus())}),downloadLevel:i=>fn(async()=>{let e=ne,{name:t,blob:n}=await Rt.file(cc(e.job,i));Bi(n,e.named(t))}),download:i=>fn(async()=>{let e=ne,{job:t}=e;if(i!==e.given){if(t=await La({operation:"repair",input:{job:e.inputJob},...e.asked,output_format:i},null),e!==ne)return;if(t.problem)throw new Lt(t.problem);Object.assign(e,{report:await Rt.report(t),job:t,given:i}),gs(),Pa(),ft.overlays()}let{name:n,blob:s}=await Rt.file(t.links.result);Bi(s,e.named(n))}),openReport:()=>fn(async()=>{if(!Rt.key)return void window.open(ne.job.links.report,"_blank","noopener");let{downloadStem:i,job:e}=ne,{blob:t}=await Rt.file(e.links.report,"text/html");return Bi(t,`${i}.report.html`)}),curl:()=>rd(ne),words:fc,async verify(i){let[e,t]=await Promise.all([i.arrayBuffer().then(n=>Sc.ask("digest",{bytes:n},[n])),Rt.create({operation:"verify"},i).then(n=>Rt.follow(n,()=>{}))]);if(t.problem)throw new Lt(t.problem);return{digest:e,isValid:(await Rt.report(t)).verdict.printable}}};async function jx(){let i=ne;i.looks+=1,vr(),B("repair").disabled=!0,i.choices.takesBest=B("best").checked,i.choices.share=Number(B("share").value)/100,i.choices.levels=Number(B("levels").value);let e={unit:B("units").value,policy:B("policy").value},t=i.repairOptions(e),n=await La({operation:"repair",thumbnail:!0,input:{job:i.inputJob},...t},null);if(i!==ne)return;let s=i.fileUnit;Object.assign(i,{asked:t,isAskedKnown:!0},e),B("repair").classList.remove("wanted"),i.fileUnit!==s&&await Dd(Bd()),await Fd(n)}async function Fd(i){let e=ne;if(i.links.result&&Zn(Q("status.fetching")),await bc(i),e===ne){if(e.level=0,ft.light(null),e.place=null,Oi(jn,e,Dt,null,0),i.links.result){if(await ft.drawResult(i),e!==ne)return;bt?.comeBack()}else delete e.pictures.after,Jn?.offer(!1);B("panel").scrollTop=0,window.scrollTo(0,0),Fi(B("verdict"))}}function Ia(){let i=Number(B("share").value)/100;B("share-text").textContent=i===1?Q("simplify.all"):Q("simplify.share",{p:Dn(i),n:$e((ne?.triangleCount??0)*i)}),B("share").setAttribute("aria-valuetext",B("share-text").textContent)}async function Jx(){return!ne.isRepaired&&!B("repair").disabled?wc():(Dt.changed(),_c())}function _c(){let{isRepaired:i,unit:e,policy:t,asked:n}=ne,s=(o,a)=>B(o).value!==a,r=i&&(s("units",e)||s("policy",t)||s("solid",n?.parts??"separate"));B("earlier").textContent=r?Q("earlier"):""}async function wc(){if(!ne.inputJob&&!ne.file)return;let i=ne;document.body.dataset.state="open";let e=i.fileUnit;i.unit=B("units").value,i.policy=B("policy").value,Jn?.offer(!1),bt?.clear("after"),delete i.pictures.after;let t=i.pictures.before&&e===i.fileUnit;await Nd(t?null:Bd())}async function Kx(){let i=[ne.solid,B("solid").value].includes("together");if(ne.solid=B("solid").value,Dt.changed(),_c(),!!i){if(ne.choices=new wi,ne.isRepaired||B("repair").disabled)return Dt.refresh();ne.place=null,ft.light(null),await wc()}}async function Bd(){return ne.file?Id(ne):ne.report?ft.drawFromService().catch(i=>({error:i})):{error:!0}}async function yc(i){let e=wd(i);Mc(e?.name??i.slice(0,8),null,!!e);let t=ne;Ca(i),await fn(async()=>{Zn(Q("status.queued"));let n=await Ud(await Rt.job(i));if(t===ne){if(n.operation==="boolean"&&n.links.result)return void Ld(n,t.name);if(t.inputJob=i,!["plan","repair"].includes(n.operation))throw new Lt({code:"not-found"});await Qx(n,e?.asked),t===ne&&(await bc(n),t===ne&&(await ft.drawFromService(),t===ne&&(gs(),n.operation==="repair"&&await Fd(n))))}},t)}async function Qx(i,e){let t=ne,n=e??sd(await Rt.report(i));t===ne&&(t.take(n),Pd(),t.take({...n,units:B("units").value,policy:B("policy").value}),Object.assign(t,{asked:n,isAskedKnown:!!e}))}function Cd(){let i=Ra().map(({id:e,name:t,operation:n,at:s})=>W("li",{},W("a",{href:`#job=${e}`,onclick:()=>{B("jobs").open=!1}},W("strong",{},t),W("span",{},`${Q(`operation.${n}`)}, ${new Date(s).toLocaleString(ys())}`))));B("jobs-list").replaceChildren(...i.length?i:[W("li",{className:"note"},Q("jobs.none"))]),B("jobs-forget").hidden=i.length===0}function ey(){try{bt=new Ma(B("canvas"),{onDrawn:()=>{ft.ring(),B("view").dataset.frames=String(Number(B("view").dataset.frames??0)+1)},onEased:()=>ft.tellEased()}),ft.view=bt}catch{B("no-webgl").hidden=!1,document.body.classList.add("flat");return}Jn=new Aa(bt,Sc,()=>ne),ft.tools=Jn}var kd=matchMedia("(prefers-color-scheme: dark)"),zd=()=>document.documentElement.dataset.theme??(kd.matches?"dark":"light"),Ec=()=>bt?.setTheme(zd());function ty(i){document.documentElement.dataset.theme=i;try{localStorage.setItem("theme",i)}catch{}Ec()}function ny(){try{let i=localStorage.getItem("theme");i&&(document.documentElement.dataset.theme=i)}catch{}}var Gd=matchMedia("(max-width: 760px)"),Vd=()=>B(Gd.matches?"facts":"corner").append(B("textured"),B("far"),B("coarse"));function Hd(){document.documentElement.lang=ys(),Gc(document),Ia(),ne?.report&&Pa(),ft.tellEased(),ft.tellFar(),Jn?.color(B("colors").value)}function iy(){mc(document.body,Rd),B("file").addEventListener("change",()=>{Rd(B("file").files),B("file").value=""});for(let i of Object.keys(xc))B(`sample-${i}`).addEventListener("click",()=>ur(Td(i)));B("repair").addEventListener("click",()=>fn(jx)),B("cancel").addEventListener("click",()=>hr&&fn(()=>Rt.cancel(hr))),B("share").addEventListener("input",()=>{Ia(),Dt.changed()});for(let i of["best","levels"])B(i).addEventListener("change",Dt.changed);for(let i of["units","policy"])B(i).addEventListener("change",()=>fn(Jx));B("solid").addEventListener("change",()=>fn(Kx)),B("jobs").addEventListener("toggle",Cd),document.addEventListener("pointerdown",i=>{B("jobs").contains(i.target)||(B("jobs").open=!1)}),B("jobs").addEventListener("keydown",i=>{i.key==="Escape"&&(B("jobs").open=!1,B("jobs").querySelector("summary").focus())}),B("jobs-forget").addEventListener("click",()=>{_d(),Cd()}),B("language").value=ys(),B("language").addEventListener("change",()=>{Ua(B("language").value),Hd()}),B("theme").addEventListener("click",()=>ty(zd()==="dark"?"light":"dark")),kd.addEventListener("change",Ec),Gd.addEventListener("change",Vd),B("key-form").addEventListener("submit",i=>{i.preventDefault(),Rt.useKey(B("key").value),B("key-form").hidden=!0,ne?.file?ur(ne.file):yi()&&yc(yi())}),window.addEventListener("hashchange",()=>{yi()&&yi()!==ne?.job?.id&&yc(yi())}),document.addEventListener("keydown",i=>{let e=i.target.closest("input:not([type=checkbox]), select, textarea")||i.ctrlKey||i.metaKey||i.altKey,t={n:1,N:1,p:-1,P:-1}[i.key];e||!t||!ne?.report||(i.preventDefault(),Dt.step(t))})}gr.includes(ys())||Ua("en");ey();iy();Hd();ny();Ec();Vd();yi()&&yc(yi());document.body.dataset.ready="true";
